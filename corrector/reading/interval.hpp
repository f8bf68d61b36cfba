#pragma once
/// @file
/// The part of an occupation whose mean stands for it.

#include <cstddef>
#include <span>
#include <vector>

namespace a351::corrector {

/// Samples first..last, both included, without a pulse between them.
struct Part {
    std::size_t first = 0;
    std::size_t last = 0;
    bool disturbed_first = false;  ///< The left side lies next to a disturbance.
    bool disturbed_last = false;   ///< The right side.
    bool split = false;            ///< Pulses cut the record; this is the longest part.
};

/// A disturbed sample farther than `margin` from both ends is a pulse.  The record is split at
/// pulses and the longest part kept (the earliest of several); its sides next to a pulse are
/// disturbed.  A side at an end of the record is disturbed if a sample within `margin` of it is.
///
/// @param disturbed  (n) from find_disturbances(), n >= 1.
/// @param margin     Samples.
[[nodiscard]] Part choose_part(const std::vector<bool>& disturbed, std::size_t margin);

/// Samples first..last of the part, both included.
struct Interval {
    std::size_t first = 0;
    std::size_t last = 0;
    bool fallback = false;  ///< Extrema were lacking; a rule below the first one was used.
};

/// Chooses the interval from the extrema of the trend curve, so that a disturbed side lies at a
/// comparable phase of the slow oscillation, clear of the disturbance.
///
/// 1. An undisturbed side lies at the end of the curve, a disturbed one at the second extremum from
///    it; lacking that, at the first; lacking that, at the end (the last two are fallbacks).
/// 2. If no more than one sample is left: first to last extremum, or the whole (fallbacks).
///
/// A flat extremum is at its middle, rounded down.
///
/// @param curve  (n) trend curve of one part, n >= 1.
[[nodiscard]] Interval choose_interval(std::span<const double> curve, bool disturbed_first,
                                       bool disturbed_last);

}  // namespace a351::corrector
