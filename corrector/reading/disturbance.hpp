#pragma once
/// @file
/// Samples that stand out of their surroundings: knocks, footsteps, the operator's hands.

#include <span>
#include <vector>

namespace a351::corrector {

/// Of the largest sample: smaller differences are rounding, not noise.
inline constexpr double kSampleRounding = 1e-12;

struct Disturbances {
    std::vector<bool> disturbed;   ///< (n)
    std::vector<double> baseline;  ///< (n) What each sample was compared with, unit of the series.
};

/// Says of every sample whether it is farther from a running median of 61 samples than `threshold`
/// times the scaled median absolute deviation (1.4826 MAD, the standard deviation of Gaussian
/// noise) of all samples from that median.
///
/// The median slope of the whole series is removed first.  Next to the ends, where no window of 61
/// is centred, the median of the outermost window is continued along the median slope within it: a
/// steady drift is no disturbance.  A series shorter than 61 is one window.  Deviations of less
/// than kSampleRounding of the largest sample do not count.
///
/// @param series     Finite samples, any unit.
/// @param threshold  > 0
/// Source: R. K. Pearson et al., EURASIP J. Adv. Signal Process. 2016:87 (Hampel filter).  Departs
/// from it in one deviation for the whole record, which a long disturbance cannot raise so easily.
[[nodiscard]] Disturbances find_disturbances(std::span<const double> series, double threshold);

/// The series with its baseline in the place of every disturbed sample.
/// @param found  find_disturbances() of `series`.
[[nodiscard]] std::vector<double> despike(std::span<const double> series,
                                          const Disturbances& found);

}  // namespace a351::corrector
