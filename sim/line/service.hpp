#pragma once

#include <poll.h>

#include <functional>
#include <span>
#include <vector>

#include "protocol/core/clock_scale.hpp"
#include "sim/device/line_device.hpp"

namespace a351::sim {

/// One of the things the emulator attends to: the sensor's port, the oven's, the control socket.
class Service {
public:
    virtual ~Service() = default;

    /// Does what can be done now without waiting.
    virtual void serve(const Instant& now) = 0;

    /// Adds the descriptors whose stirring should wake it.
    virtual void watch(std::vector<pollfd>& descriptors) const = 0;

    /// Real time after which it wants to be served although nothing stirs; at least 0.
    [[nodiscard]] virtual Nanoseconds patience(const Instant& now,
                                               const ClockScale& clock) const = 0;
};

/// Attends to all of them in turn, in one thread, until `should_stop` says so (asked ten times a
/// second at least).  Reads the host's clock; `clock` turns it into simulated time.
/// @throws std::system_error  the descriptors cannot be waited for; what a service throws.
void attend(std::span<Service* const> services, const ClockScale& clock,
            const std::function<bool()>& should_stop);

/// The host's realtime clock, and its steady clock.
[[nodiscard]] UtcTime host_now();
[[nodiscard]] Nanoseconds steady_now();

}  // namespace a351::sim
