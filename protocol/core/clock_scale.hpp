#pragma once

#include <optional>
#include <string_view>

#include "protocol/core/utc_time.hpp"

namespace a351 {

/// Simulated time as a function of the host clock, shared by every program of one simulation:
///
///     simulated = utc + factor (host clock - host)
///
/// Accuracy: the product is rounded to 1 ns; it is exact while factor x (host clock - host) is
/// below 104 days.
struct ClockScale {
    double factor = 1.0;  ///< Simulated seconds per second, > 0.
    UtcTime utc;          ///< Simulated instant at the host time `host`.
    UtcTime host;         ///< Instant of the host clock.

    /// Returns the simulated time at the host time `host_now`.
    [[nodiscard]] UtcTime simulated(UtcTime host_now) const;
    /// Returns the host time of a simulated instant: the inverse of simulated().
    [[nodiscard]] UtcTime host_at(UtcTime simulated_time) const;
};

/// Reads `scaled:FACTOR@UTC[,HOST]`, the value of --clock; HOST defaults to `host_now`.
/// @return std::nullopt unless FACTOR is a number in (0, 1e6] and both instants are RFC 3339.
[[nodiscard]] std::optional<ClockScale> parse_clock_scale(std::string_view text, UtcTime host_now);

}  // namespace a351
