#pragma once
/// @file
/// What is held of a host's clocks, live and in hindsight.

#include <chrono>

#include "protocol/core/utc_time.hpp"

namespace a351::timing {

/// Boottime gains this on the raw clock between readings: the host slept.  Slewing makes 0.6 ms of a
/// second.
inline constexpr Nanoseconds kShortestSleep = std::chrono::milliseconds(100);

/// A clock that departs by more, beyond what slewing explains, was set.
inline constexpr Nanoseconds kClockStep = std::chrono::milliseconds(50);

/// Where sample times may jump at all, a greater jump is a break; a smaller one is slewed.
inline constexpr Nanoseconds kBreak = std::chrono::milliseconds(5);

/// After a longer loss sample times begin anew: neither clock keeps a line over more.
inline constexpr Nanoseconds kLongestLoss = std::chrono::hours(24);

/// Around the midnight of an announced leap second times may be a second off: in its minute, and in
/// records, of up to a minute, that reach into it.
inline constexpr Nanoseconds kLeapDoubt = std::chrono::minutes(2);

/// The midnight of a leap second, by a reading that announces it.  One across that midnight may be
/// after it already.
[[nodiscard]] inline UtcTime announced_midnight(UtcTime realtime) {
    return std::chrono::ceil<std::chrono::days>(realtime - kLeapDoubt);
}

/// Of a clock that was never synchronised, or that only a battery clock carried through a sleep.
inline constexpr Nanoseconds kUnknownClockError = std::chrono::seconds(1);

/// 500 ppm of the kernel (MAXFREQ) + a crystal.
inline constexpr std::int64_t kMostSlew_ppm = 600;
[[nodiscard]] constexpr Nanoseconds most_slewed(Nanoseconds duration) {
    return duration / 1'000'000 * kMostSlew_ppm;
}

/// Of a host's crystal without discipline: twice what they are usually specified to.
inline constexpr std::int64_t kHostRateError_ppm = 100;
inline constexpr double kHostRateError = 1e-6 * kHostRateError_ppm;
[[nodiscard]] constexpr Nanoseconds host_drift(Nanoseconds duration) {
    return duration / 1'000'000 * kHostRateError_ppm;
}

}  // namespace a351::timing
