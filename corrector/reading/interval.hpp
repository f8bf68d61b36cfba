#pragma once
/// @file
/// The part of an occupation that is averaged.

#include <cstddef>
#include <span>
#include <vector>

namespace a351::corrector {

/// Samples first..last, both included.  No pulse (see choose_part()) is between them.
struct Part {
    std::size_t first = 0;
    std::size_t last = 0;
    bool disturbed_first = false;  ///< A disturbance is next to the first sample.
    bool disturbed_last = false;   ///< A disturbance is next to the last sample.
    bool split = false;            ///< Pulses cut the record; this is the longest part.
};

/// Returns the longest part of a record between pulses.
///
/// A pulse is a disturbed sample farther than `margin` from both ends.  The record is split at
/// pulses, and the longest part is kept (the earliest of several).  A side of the part next to a
/// pulse is disturbed.  A side at an end of the record is disturbed if a sample within `margin` of
/// it is.
///
/// The part has at least one sample, because the outermost samples are never pulses.
///
/// @param disturbed  (n) from find_disturbances(), n >= 1.
/// @param margin     samples, >= 0.
[[nodiscard]] Part choose_part(const std::vector<bool>& disturbed, std::size_t margin);

/// Samples first..last of the part, both included.
struct Interval {
    std::size_t first = 0;
    std::size_t last = 0;
    bool fallback = false;  ///< A fallback was used, because the curve has too few extrema.
};

/// Chooses the interval from the extrema of the trend curve.  A disturbed side is put at a
/// comparable phase of the slow oscillation, away from the disturbance.
///
/// 1. An undisturbed side is at the end of the curve.
/// 2. A disturbed side is at the second extremum from its end.  With only one extremum it is there;
///    without extrema it is at the end (both are fallbacks).
/// 3. If at most one sample is left, the interval is from the first extremum to the last.  With
///    fewer than two extrema it is the whole curve (both are fallbacks).
///
/// The position of a flat extremum is its middle, rounded down
/// (tests/unit/reading/interval_test.cpp).
///
/// @param curve  (n) trend curve of one part, any unit, finite; n >= 1.
/// @param disturbed_first, disturbed_last  from choose_part().
[[nodiscard]] Interval choose_interval(std::span<const double> curve, bool disturbed_first,
                                       bool disturbed_last);

}  // namespace a351::corrector
