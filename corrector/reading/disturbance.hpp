#pragma once
/// @file
/// Samples that differ from their surroundings: knocks, footsteps, the operator's hands.

#include <span>
#include <vector>

namespace a351::corrector {

/// Smallest deviation that counts, as a fraction of the largest sample.  Reason: smaller
/// differences are rounding, not noise.
inline constexpr double kSampleRounding = 1e-12;

/// Result of find_disturbances().
struct Disturbances {
    std::vector<bool> disturbed;   ///< (n) True for each disturbed sample.
    std::vector<double> baseline;  ///< (n) Undisturbed level, unit of the series.
};

/// Finds the samples far from a running median of 61 samples.
///
/// A sample is disturbed if its deviation from the running median is larger than
///
///     threshold x 1.4826 MAD
///
/// where MAD is the median absolute deviation of all samples of the series from the running median;
/// 1.4826 MAD is the standard deviation of Gaussian noise.  Deviations of less than kSampleRounding
/// of the largest sample do not count.
///
/// The median slope of the whole series is removed first, so that a steady drift is no disturbance.
/// Next to the ends, where no window of 61 samples is centred, the median of the outermost window
/// is continued along the median slope within it.  A series shorter than 61 samples is one window.
///
/// Tests (disturbance_test.cpp): noise on drifts up to 20 deviations per sample has no disturbance
/// at threshold 8; a single sample 10 deviations off is found, also at the ends, and does not count
/// at threshold 14; under a transient of 40 deviations at the start the baseline is within 3.
///
/// @param series     (n) finite samples at constant rate, any unit; any n, also 0.
/// @param threshold  number of standard deviations, > 0.
/// @return (n) flags and baseline.
/// Source: R. K. Pearson et al., EURASIP J. Adv. Signal Process. 2016:87 (Hampel filter).
/// Different here: one MAD for the whole record, which a long disturbance raises less.
[[nodiscard]] Disturbances find_disturbances(std::span<const double> series, double threshold);

/// Returns the series with every disturbed sample replaced by the baseline.
/// @param series  (n), as given to find_disturbances().
/// @param found   find_disturbances() of `series`.
[[nodiscard]] std::vector<double> despike(std::span<const double> series,
                                          const Disturbances& found);

}  // namespace a351::corrector
