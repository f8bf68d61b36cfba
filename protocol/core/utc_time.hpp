#pragma once
/// @file
/// Instants: UTC, and the host's raw monotonic clock.  Neither is read inside a computation.
///
/// UtcTime is for everything that is stored or shown.  RawTime is for arrivals and delays in one
/// run of the host, because a correction of the clock does not change it.  The two cannot be mixed:
/// their difference does not compile (tests/compile_fail).  A plain number of seconds becomes a
/// duration only by from_seconds().
///
///     const auto time = parse_rfc3339("2017-07-16T09:00:00+09:00");
///     if (time) to_rfc3339(*time, 3);  // "2017-07-16T00:00:00.000Z"
///
/// All functions depend on their arguments only, not on locale or time zone of the host.  Any
/// number of threads may call them.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace a351 {

/// Duration in whole nanoseconds, at most 292 years.  An overflow of a sum is not checked.
using Nanoseconds = std::chrono::nanoseconds;

/// UTC without leap seconds: every day has 86 400 s.  Range 1678-2262.
///
/// A default-constructed instant is 1970-01-01T00:00:00Z, which is not a mark for "unknown": use
/// std::optional.  A leap second has no instant of its own, so a difference of two instants across
/// it is 1 s less than the elapsed time.
using UtcTime = std::chrono::sys_time<Nanoseconds>;

/// The host's CLOCK_MONOTONIC_RAW: never stepped, never slewed; its zero is the host's start.
///
/// The type has no now(): whoever reads the clock passes its time.  Instants of two starts of the
/// host cannot be compared.
struct RawClock {
    using duration = Nanoseconds;
    using rep = duration::rep;
    using period = duration::period;
    using time_point = std::chrono::time_point<RawClock>;
    static constexpr bool is_steady = true;
};
/// Instant of RawClock; a default-constructed one is its zero.
using RawTime = RawClock::time_point;

/// Reads RFC 3339 `YYYY-MM-DDThh:mm:ss[.fraction](Z|+hh:mm|-hh:mm)`; a blank may replace the T.
/// Digits beyond the ninth decimal are dropped.  Second 60 is refused.  Years: 1678 to 2261.
///
/// Letters are upper case: `t` and `z` are refused, although RFC 3339 allows them.  Blanks around
/// the text and a fraction without digits are refused.  A zone has at most 23 h 59 min; `-00:00` is
/// UTC.
/// @return std::nullopt unless the whole text is one valid instant within the range of UtcTime.
[[nodiscard]] std::optional<UtcTime> parse_rfc3339(std::string_view text);

/// Reads an instant like parse_rfc3339; if the text has no zone, it is `zone` east of Greenwich.
/// A zone in the text has priority: 08:42:12 with 9 h is 23:42:12Z of the day before.
/// @param zone  local time minus UTC, less than 24 h either way; not checked.
/// @return std::nullopt as parse_rfc3339().
[[nodiscard]] std::optional<UtcTime> parse_rfc3339_in_zone(std::string_view text,
                                                           std::chrono::minutes zone);

/// Returns RFC 3339 text in UTC with `decimals` (0-9) digits of the second, truncated to the past.
/// With 9 decimals parse_rfc3339() gives the same instant, if its year is 1678 to 2261.  Texts with
/// equal decimals sort like their instants.
/// @param decimals  less than 0 counts as 0, more than 9 as 9; with 0 the text has no point.
[[nodiscard]] std::string to_rfc3339(UtcTime time, int decimals = 0);

/// Returns the second of an instant for names, as "20260301T130000Z".
[[nodiscard]] std::string to_compact(UtcTime time);

/// Returns the seconds between any two instants; exact to 1 ns up to 104 days.
///
/// The value is negative if `to` is earlier.  Beyond 104 days the steps of a double are wider than
/// 1 ns: 0.12 us at 30 years.  A subtraction of the instants is exact: it gives whole nanoseconds.
[[nodiscard]] constexpr double seconds_between(UtcTime from, UtcTime to) noexcept {
    constexpr double kNanoseconds = 1e9;
    const auto begin = from.time_since_epoch().count(), end = to.time_since_epoch().count();
    // More than 292 years, as between a mistyped year and today, are not a number of nanoseconds.
    if (UtcTime::rep difference{}; !__builtin_sub_overflow(end, begin, &difference))
        return static_cast<double>(difference) / kNanoseconds;
    return (static_cast<double>(end) - static_cast<double>(begin)) / kNanoseconds;
}

/// Returns the nearest whole number of nanoseconds, halves away from zero, up to 52 days.  Beyond
/// 52 days the result can be wrong by 2 ns.  Beyond 104 days it is wrong by up to the step of a
/// double, which is 1 us at the limit.
/// @param seconds  finite, magnitude below 9e9; not checked.  NaN and larger values are undefined
///                 behaviour.
[[nodiscard]] constexpr Nanoseconds from_seconds(double seconds) noexcept {
    const double nanoseconds = seconds * 1e9;
    return Nanoseconds(static_cast<std::int64_t>(nanoseconds + (nanoseconds < 0 ? -0.5 : 0.5)));
}

}  // namespace a351
