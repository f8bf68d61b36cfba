#pragma once
/// @file
/// The slow part of a series by penalised least squares, with its uncertainty.

#include <cstddef>
#include <span>
#include <vector>

#include "corrector/reading/penalised_fit.hpp"

namespace a351::corrector {

/// Limits of the cut-off period in samples.  Below, nothing is smoothed; above, rounding shows
/// (penalised_fit.hpp): decimate first.
inline constexpr double kShortestCutoff = 2.0;
inline constexpr double kLongestCutoff = 5000.0;

/// Two samples make a line, which leaves no residual.
inline constexpr std::size_t kFewestSamples = 3;

/// Of a sample's magnitude: squares of larger ones, and their sums, can overflow.
inline constexpr double kLargestSample = 1e150;

struct SmoothTrend {
    std::vector<double> curve;        ///< (n) Unit of the series.
    std::vector<double> weights;      ///< (n) 0 (missing, or an outlier) to 1.
    double noise_level = 0.0;         ///< Standard deviation of one sample about the curve.
    double degrees_of_freedom = 0.0;  ///< Trace of the matrix that makes the curve.
    bool converged = false;           ///< The weights settled to 1e-6.
    PenalisedFit fit;                 ///< Of the weights: the errors come from its factors.

    /// Of every point of the curve, (n).
    [[nodiscard]] std::vector<double> standard_errors() const;

    /// Of the curve's mean over the points first..last, both included; last < n.
    [[nodiscard]] double standard_error_of_mean(std::size_t first, std::size_t last) const;
};

/// Whittaker's smoother with the penalty that halves a sine of the period `cutoff_period`.
///
/// A sample that is missing (not finite) has weight 0: the curve goes on as a cubic across a gap and
/// as a line beyond the ends.  The others have weight 1 up to three standard deviations s of the
/// residuals (1.4826 times their median magnitude), and less beyond, none from six on,
///
///     w = (1 - u^2)^2,  u = (|residual| / s - 3) / 3
///
/// so that Gaussian noise is fitted by plain least squares and an outlier not at all; s is at least
/// 1e-12 of the largest sample, which is rounding.  The weights are found by repetition from 1.
///
/// The residuals must be noise for this.  Where the series has none and is a curve narrower than the
/// cut-off, they are what the smoother takes off it, and s is of their size: the sharpest turns then
/// lose weight like outliers.
///
/// Standard errors: noise_level sqrt(a' A^-1 a), that is the curve's posterior deviation if its own
/// second differences are white and of the penalty's size (G. Wahba, J. R. Stat. Soc. B 45(1),
/// 133-150, 1983); smoother_test.cpp counts how often they hold.  Noise that is correlated over
/// many samples makes them too small.
///
/// @param series         (n) any unit; n >= 3, of which at least three are finite; these at most
///                       kLargestSample in magnitude.
/// @param cutoff_period  Samples, kShortestCutoff to kLongestCutoff: the one parameter.
/// @throws std::invalid_argument  fewer samples, larger ones, another period, or samples that do not
///                                determine the curve (PenalisedFit) or leave no noise to measure.
/// Source: penalised_fit.hpp; weights as in F. R. Hampel et al., Robust Statistics, Wiley, 1986,
/// section 2.6 (redescending).  Departs from it in the bisquare flank.
[[nodiscard]] SmoothTrend smooth(std::span<const double> series, double cutoff_period);

}  // namespace a351::corrector
