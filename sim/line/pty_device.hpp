#pragma once

#include <functional>

#include "protocol/core/clock_scale.hpp"
#include "sim/device/device_stream.hpp"
#include "sim/line/pty.hpp"
#include "sim/line/service.hpp"

namespace a351::sim {

struct PtyRun {
    bool was_drained = false;   ///< The host read everything.
    double real_seconds = 0.0;  ///< From the first frame handed over to the last.
};

/// Serves the sensor on a pseudo-terminal until the scenario ends and the host has read all of it
/// (or 2 s more have passed), or `should_stop` says so.  Frames keep an absolute grid: when the
/// terminal is full they wait, and are sent late but never lost.
///
/// Reads the host's clock; `clock` turns it into simulated time.  The device's own times (start-up,
/// tests) are real time, as are the host's time-outs.
[[nodiscard]] PtyRun serve(Pty& pty, DeviceStream& stream, const ClockScale& clock,
                           const std::function<bool()>& should_stop);

}  // namespace a351::sim
