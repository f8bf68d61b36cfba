#pragma once

#include <poll.h>

#include <functional>
#include <span>
#include <vector>

#include "protocol/core/clock_scale.hpp"
#include "sim/device/line_device.hpp"

namespace a351::sim::line {

/// A part of the emulator, served in turn: the sensor's port, the oven's port, the control socket.
class Service {
public:
    virtual ~Service() = default;

    /// Does everything that can be done now without waiting.
    virtual void serve(const device::Instant& now) = 0;

    /// Adds the descriptors whose events should wake it.
    virtual void watch(std::vector<pollfd>& descriptors) const = 0;

    /// Returns the real time after which it must be served even without an event; >= 0.
    [[nodiscard]] virtual Nanoseconds patience(const device::Instant& now,
                                               const ClockScale& clock) const = 0;
};

/// Serves all services in turn, in one thread, until `should_stop` returns true (asked at least ten
/// times a second).  Reads the host's clock, which `clock` converts to simulated time.
/// @throws std::system_error  the descriptors cannot be polled; also everything a service throws.
void attend(std::span<Service* const> services, const ClockScale& clock,
            const std::function<bool()>& should_stop);

/// Return the host's realtime clock and its steady clock.
[[nodiscard]] UtcTime host_now();
[[nodiscard]] Nanoseconds steady_now();

}  // namespace a351::sim::line
