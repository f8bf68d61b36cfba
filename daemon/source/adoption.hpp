#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

#include "daemon/source/host_clock.hpp"
#include "daemon/source/port.hpp"
#include "protocol/journal/stream_end.hpp"

namespace a351::daemon {

/// One read of the port.
struct Heard {
    RawTime time;
    std::vector<std::byte> bytes;
};

struct Listening {
    enum class Outcome {
        goes_on,    ///< The stream that was known: not to be touched.
        not_known,  ///< Silence, or anything else: to be stopped and configured.
        port_gone,
    };
    Outcome outcome = Outcome::not_known;
    std::vector<Heard> reads;  ///< All that came.
};

/// Listens on a port just opened, at most half a second into silence.  The stream is the one that
/// was known when ten frames in a row keep the step of its rate, and their counter stands where
/// `known` lets expect it by the rule of timing::SampleIndex: a device that restarted meanwhile
/// passes for it in one of 20 cases, when its new counter happens to be within a second of what it
/// would be now, or goes on from the old one.
/// @param stop  when it becomes true, listening ends.
[[nodiscard]] Listening listen_for(const record::StreamEnd& known, Port& port,
                                   const HostClock& clock, const std::atomic<bool>& stop);

}  // namespace a351::daemon
