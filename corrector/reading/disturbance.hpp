#pragma once
/// @file
/// Samples that differ from their surroundings: knocks, footsteps, the operator's hands.
///
/// Find them before a mean or a decomposition, which a single knock would spoil.  Gaps must be cut
/// out first, because a NaN is not accepted:
///
///     const Disturbances found = find_disturbances(series, kDisturbanceThreshold);
///     const Part part = choose_part(found.disturbed, margin);      // interval.hpp
///     const std::vector<double> clean = despike(series, found);
///
/// The functions are pure and have no state.

#include <span>
#include <vector>

namespace a351::corrector::reading {

/// Smallest deviation that counts, as a fraction of the largest sample.  Reason: smaller
/// differences are rounding, not noise.
/// It has no unit.
inline constexpr double kSampleRounding = 1e-12;

/// Result of find_disturbances().
/// Both vectors have the length of the series; a default-constructed object is that of an empty
/// one.
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
/// The baseline is found for every sample, disturbed or not.  A series of one or two samples has no
/// disturbance, because its baseline is the series itself.  Disturbances of more than 30 samples in
/// a row can become part of the baseline, at an end those of more than 15.
///
/// The time is O(n), with a median of 61 samples for each.  The result is the same for a series
/// with another level or unit, apart from rounding.
///
/// Tests (disturbance_test.cpp): noise on drifts up to 20 deviations per sample has no disturbance
/// at threshold 8; a single sample 10 deviations off is found, also at the ends, and does not count
/// at threshold 14; under a transient of 40 deviations at the start the baseline is within 3.
///
/// @param series     (n) finite samples at constant rate, any unit; any n, also 0.  NaN and
///                   infinity are not checked and make the result meaningless.
/// @param threshold  number of standard deviations, > 0; not checked.  8 for an occupation
///                   (kDisturbanceThreshold); at 3 one sample in 370 of Gaussian noise is found.
/// @return (n) flags and baseline.
/// Source: R. K. Pearson et al., EURASIP J. Adv. Signal Process. 2016:87 (Hampel filter).
/// Different here: one MAD for the whole record, which a long disturbance raises less.
[[nodiscard]] Disturbances find_disturbances(std::span<const double> series, double threshold);

/// Returns the series with every disturbed sample replaced by the baseline.
/// @param series  (n), as given to find_disturbances().
/// @param found   find_disturbances() of `series`.
///                The length is asserted.
/// @return (n), unit of the series.  The other samples keep their bits.
[[nodiscard]] std::vector<double> despike(std::span<const double> series,
                                          const Disturbances& found);

/// Returns the parts of a series without missing (NaN) and disturbed samples, in order.  Disturbances
/// are found in each part between missing samples.
/// @param shortest  parts of fewer samples are left out.
[[nodiscard]] std::vector<std::vector<double>> quiet_parts(std::span<const double> series,
                                                           double threshold, std::size_t shortest);

}  // namespace a351::corrector::reading
