#pragma once
/// @file
/// Time of a simulation that runs faster or slower than the host, and the value of the option
/// --clock that sets it.
///
/// Programs of one simulation must get the same text with a HOST.  They then agree on the simulated
/// time, also after a restart (clock_scale_test.cpp).  Without a HOST, two programs that start at
/// different times disagree by FACTOR times the difference.
///
///     const auto scale =
///         parse_clock_scale("scaled:20@2017-07-15T20:42:12Z,2026-01-01T00:00:00Z", host_now);
///     if (scale) time = scale->simulated(host_now);
///
/// No function here reads a clock: the caller passes the time of the host.

#include <optional>
#include <string_view>

#include "protocol/core/utc_time.hpp"

namespace a351 {

/// Simulated time as a function of the host clock, shared by every program of one simulation:
///
///     simulated = utc + factor (host clock - host)
///
/// Accuracy: the product is rounded to 1 ns.  The arithmetic of doubles adds a few nanoseconds at
/// most while factor x (host clock - host) is below 104 days.
///
/// Limits: product and quotient must be below 9e9 s, and the results within the range of UtcTime.
/// Neither is checked.  A default-constructed scale runs like the host, but begins in 1970:
/// instants of today are then wrong by up to 1 us.
struct ClockScale {
    double factor = 1.0;  ///< Simulated seconds per second, > 0.
    UtcTime utc;          ///< Simulated instant at the host time `host`.
    UtcTime host;         ///< Instant of the host clock.

    /// Returns the simulated time at the host time `host_now`.  A time before `host` gives an
    /// instant before `utc`.
    [[nodiscard]] UtcTime simulated(UtcTime host_now) const;
    /// Returns the host time of a simulated instant: the inverse of simulated().  The result is
    /// rounded to 1 ns of the host, which is `factor` ns of simulated time.
    [[nodiscard]] UtcTime host_at(UtcTime simulated_time) const;
};

/// Reads `scaled:FACTOR@UTC[,HOST]`, the value of --clock; HOST defaults to `host_now`.
///
/// FACTOR has a decimal point in every locale.  No blank is allowed around the parts.
/// @param host_now  time of the host; not used if the text has a HOST.
/// @return std::nullopt unless FACTOR is a number in (0, 1e6] and both instants are RFC 3339.
[[nodiscard]] std::optional<ClockScale> parse_clock_scale(std::string_view text, UtcTime host_now);

}  // namespace a351
