#pragma once
/// @file
/// Assumptions about a host's clocks, used live and in hindsight.
///
/// SampleClock and UtcMapping use them live, UtcHistory in hindsight.  So both judge a sleep, a
/// step and a leap second by the same limits.

#include <chrono>

#include "protocol/core/utc_time.hpp"

namespace a351::timing {

/// Least gain of CLOCK_BOOTTIME on the raw clock between two readings that means that the host
/// slept.  Slewing gains 0.6 ms per second.  A shorter sleep is not noticed and remains as an
/// error.
inline constexpr Nanoseconds kShortestSleep = std::chrono::milliseconds(100);

/// Departure of a clock, beyond the possible slewing, above which it counts as a step.  While
/// samples arrive, a step must first be confirmed, see UtcMapping.
inline constexpr Nanoseconds kClockStep = std::chrono::milliseconds(50);

/// Largest jump of sample times that is removed by slewing; a larger one is a break, if there is a
/// cause for a jump.
inline constexpr Nanoseconds kBreak = std::chrono::milliseconds(5);

/// Longest loss of data across which sample times are continued; neither clock keeps a line for
/// longer.
inline constexpr Nanoseconds kLongestLoss = std::chrono::hours(24);

/// Time before and after the midnight of an announced leap second in which times may be 1 s off:
/// the minute of the leap second, and records of up to a minute that reach into it.
inline constexpr Nanoseconds kLeapDoubt = std::chrono::minutes(2);

/// Returns the midnight of a leap second that a reading at `realtime` announces.  A reading taken
/// across that midnight may already show a later time.
///
/// The result is the next midnight, or the last one if it is at most 2 min ago.
[[nodiscard]] inline UtcTime announced_midnight(UtcTime realtime) {
    return std::chrono::ceil<std::chrono::days>(realtime - kLeapDoubt);
}

/// Least error of a clock that was never synchronised, or that only a battery clock kept during a
/// sleep.
inline constexpr Nanoseconds kUnknownClockError = std::chrono::seconds(1);

/// Largest rate of a slewed clock, ppm: 500 of the kernel (MAXFREQ) + 100 of a crystal.
inline constexpr std::int64_t kMostSlew_ppm = 600;
/// Returns the largest change of a slewed clock within `duration`; only whole milliseconds of it
/// count.  Negative for a negative duration.
[[nodiscard]] constexpr Nanoseconds most_slewed(Nanoseconds duration) {
    return duration / 1'000'000 * kMostSlew_ppm;
}

/// Largest rate error of a host's undisciplined crystal, ppm: twice the usual specification.
inline constexpr std::int64_t kHostRateError_ppm = 100;
/// The same as a dimensionless ratio.
inline constexpr double kHostRateError = 1e-6 * kHostRateError_ppm;
/// Returns the largest drift of such a crystal within `duration`; only whole milliseconds of it
/// count.  Negative for a negative duration.
[[nodiscard]] constexpr Nanoseconds host_drift(Nanoseconds duration) {
    return duration / 1'000'000 * kHostRateError_ppm;
}

}  // namespace a351::timing
