#pragma once
/// @file
/// Instants: UTC, and the host's raw monotonic clock.  Neither is read inside a computation.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace a351 {

using Nanoseconds = std::chrono::nanoseconds;

/// UTC without leap seconds: every day has 86 400 s.  Range 1678-2262.
using UtcTime = std::chrono::sys_time<Nanoseconds>;

/// The host's CLOCK_MONOTONIC_RAW: never stepped, never slewed; its zero is the host's start.
struct RawClock {
    using duration = Nanoseconds;
    using rep = duration::rep;
    using period = duration::period;
    using time_point = std::chrono::time_point<RawClock>;
    static constexpr bool is_steady = true;
};
using RawTime = RawClock::time_point;

/// Reads RFC 3339 `YYYY-MM-DDThh:mm:ss[.fraction](Z|+hh:mm|-hh:mm)`; a blank may replace the T.
/// Digits beyond the ninth decimal are dropped.  Second 60 is refused.  Years: 1678 to 2261.
/// @return std::nullopt unless the whole text is one valid instant within the range of UtcTime.
[[nodiscard]] std::optional<UtcTime> parse_rfc3339(std::string_view text);

/// Reads an instant like parse_rfc3339; if the text has no zone, it is `zone` east of Greenwich.
[[nodiscard]] std::optional<UtcTime> parse_rfc3339_in_zone(std::string_view text,
                                                           std::chrono::minutes zone);

/// Returns RFC 3339 text in UTC with `decimals` (0-9) digits of the second, truncated to the past.
[[nodiscard]] std::string to_rfc3339(UtcTime time, int decimals = 0);

/// Returns the seconds from `from` to `to`; exact to 1 ns up to 104 days.
[[nodiscard]] constexpr double seconds_between(UtcTime from, UtcTime to) noexcept {
    return std::chrono::duration<double>(to - from).count();
}

/// Returns the nearest whole number of nanoseconds, halves away from zero.
/// @param seconds  finite, magnitude below 9e9; not checked.
[[nodiscard]] constexpr Nanoseconds from_seconds(double seconds) noexcept {
    const double nanoseconds = seconds * 1e9;
    return Nanoseconds(static_cast<std::int64_t>(nanoseconds + (nanoseconds < 0 ? -0.5 : 0.5)));
}

}  // namespace a351
