#pragma once
/// @file
/// The only place in the daemon that reads the time of the instrument.  With a scale the time is
/// simulated: raw time and boot time are then the simulated UTC since its epoch, and the clock is
/// always synchronised.

#include <optional>
#include <string>

#include "protocol/core/clock_scale.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/timing/clock_reading.hpp"

namespace a351::daemon::source {

class HostClock {
public:
    explicit HostClock(std::optional<ClockScale> scale = std::nullopt) : scale_(scale) {}

    [[nodiscard]] RawTime raw() const;
    [[nodiscard]] UtcTime now() const;

    /// Returns boot time minus raw time, which grows by the time that the host sleeps.
    [[nodiscard]] Nanoseconds slept() const;

    /// Reads all clocks.  They are read five times between two readings of the raw clock; the
    /// narrowest pair is used, so they belong to `raw` within half its width.
    [[nodiscard]] timing::ClockReading read() const;

    /// Converts a span of instrument time to real time.
    [[nodiscard]] Nanoseconds real_span(Nanoseconds instrument_span) const;

    /// Converts a span of real time to instrument time.
    [[nodiscard]] Nanoseconds instrument_span(Nanoseconds real_span) const;

    /// Identifies the zero of raw(): the kernel's boot identifier, or "simulated".
    [[nodiscard]] std::string boot_id() const;

private:
    std::optional<ClockScale> scale_;
};

/// Reads the host's realtime clock, unscaled.  --clock is anchored to it.
[[nodiscard]] UtcTime host_realtime();

}  // namespace a351::daemon::source
