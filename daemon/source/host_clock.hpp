#pragma once
/// @file
/// The only place of the daemon that reads the time of the instrument.  With a scale it is
/// simulated: then raw time and boot time are the simulated UTC since its epoch, and synchronised.

#include <optional>
#include <string>

#include "protocol/core/clock_scale.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/timing/clock_reading.hpp"

namespace a351::daemon {

class HostClock {
public:
    explicit HostClock(std::optional<ClockScale> scale = std::nullopt);

    [[nodiscard]] RawTime raw() const;
    [[nodiscard]] UtcTime now() const;

    /// Boot time less raw time: grows by what the host sleeps.
    [[nodiscard]] Nanoseconds slept() const;

    /// All clocks; they belong to `raw` within half of the narrowest of five brackets.
    [[nodiscard]] timing::ClockReading read() const;

    /// How long a span of instrument time lasts in reality.
    [[nodiscard]] Nanoseconds real_span(Nanoseconds instrument_span) const;

    /// The inverse of real_span().
    [[nodiscard]] Nanoseconds instrument_span(Nanoseconds real_span) const;

    /// Names the zero of raw(): the kernel's boot identifier, or "simulated".
    [[nodiscard]] std::string boot_id() const;

private:
    std::optional<ClockScale> scale_;
};

/// The host's realtime clock, unscaled: what --clock is anchored to.
[[nodiscard]] UtcTime host_realtime();

}  // namespace a351::daemon
