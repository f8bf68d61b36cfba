#pragma once
/// @file
/// The slow part of a series by penalised least squares, with its uncertainty.
///
/// Use it for a slow curve through noisy samples with outliers and gaps.  Its only parameter is the
/// period that is halved.  Use trend_curve() for a trend without a chosen period.
///
///     const SmoothTrend trend = smooth(series, 150.0);   // 300 s for samples every 2 s
///     if (!trend.converged) doubt();
///     const std::vector<double> errors = trend.standard_errors();
///     const double error = trend.standard_error_of_mean(0, series.size() - 1);

#include <cstddef>
#include <span>
#include <vector>

#include "corrector/reading/penalised_fit.hpp"

namespace a351::corrector::reading {

/// Limits of the cut-off period, samples.  Reason: a shorter one smooths nothing.  With a longer
/// one rounding becomes visible (penalised_fit.hpp); decimate first.  Both limits are permitted.
inline constexpr double kShortestCutoff = 2.0;
inline constexpr double kLongestCutoff = 5000.0;

/// Smallest number of samples.  Reason: a line through two samples leaves no residual.
inline constexpr std::size_t kFewestSamples = 3;

/// Largest magnitude of a sample.  Reason: squares of larger samples, and their sums, can overflow.
inline constexpr double kLargestSample = 1e150;

/// A smooth curve with its uncertainty.
///
/// It comes from smooth(); it has no default state.  It owns everything and can be copied.  n is
/// the length of the series, missing samples included.
struct SmoothTrend {
    std::vector<double> curve;        ///< (n), unit of the series.
    std::vector<double> weights;      ///< (n), 0 (missing, or an outlier) to 1.
    double noise_level = 0.0;         ///< Std. deviation of a sample from the curve, its unit.
    double degrees_of_freedom = 0.0;  ///< Trace of the matrix that makes the curve.
    bool converged = false;           ///< The weights settled to 1e-6.
    PenalisedFit fit;                 ///< Fit with the last weights; the errors use its factors.

    /// Returns the standard error of every point of the curve, (n), unit of the series.
    /// They are largest in gaps and at the ends.  Neighbouring points have errors in common, so the
    /// error of a mean does not follow from them.  The time is O(n).
    [[nodiscard]] std::vector<double> standard_errors() const;

    /// Returns the standard error of the curve's mean over the points first..last, both included,
    /// unit of the series.  Precondition: first <= last < n.
    /// The precondition is asserted.  The correlation between the points is included.  The time is
    /// O(n).
    [[nodiscard]] double standard_error_of_mean(std::size_t first, std::size_t last) const;
};

/// Smooths a series with Whittaker's smoother, robust against outliers.
///
/// The curve minimises the sum in penalised_fit.hpp, with the penalty that halves a sine of the
/// period P = `cutoff_period`.  A wave of period T has the gain 1 / (1 + (sin(pi/T) /
/// sin(pi/P))^4).
///
/// Weights: a missing sample (not finite) has weight 0.  The curve is a cubic across a gap and a
/// line beyond the ends.  With the residual r and the standard deviation s of the residuals (1.4826
/// times their median magnitude), the other samples have the weight
///
///     1                    |r| <= 3 s
///     (1 - u^2)^2          3 s < |r| < 6 s,  u = (|r| / s - 3) / 3
///     0                    |r| >= 6 s
///
/// Hence Gaussian noise is fitted by plain least squares, and an outlier has no effect.  s is at
/// least 1e-12 of the largest sample, which is rounding.  The weights are found by iteration from
/// 1; `converged` is false if they do not settle within 100 fits.
///
/// The curve of a series that did not settle is a fit with the last weights.  Many samples of such
/// a series lie between 3 s and 6 s; look at its record.
///
/// The residuals must be noise.  If a series has no noise and is a curve narrower than the cut-off,
/// the residuals and s are the parts of the curve that the smoother removes.  Then the sharpest
/// turns lose weight like outliers.
///
/// Standard errors are noise_level sqrt(a' A^-1 a).  This is the posterior deviation of the curve
/// if its second differences are white and of the penalty's size (G. Wahba, J. R. Stat. Soc. B
/// 45(1), 133-150, 1983).  Noise that is correlated over many samples makes them too small.
///
/// A scaled series has the scaled curve, to rounding (smoother_test.cpp).  The time is O(n) per
/// fit; weights of Gaussian noise nearly always settle within ten fits.  The function has no state.
///
/// Accuracy (smoother_test.cpp):
/// - A straight line of level 979 800 returns within 1e-8, also with gaps; a sine of the cut-off
///   period with half its height within 1e-9.
/// - Eight outliers of 500 deviations in 600 samples move the curve by less than 0.1 of the noise.
/// - Of 4000 points, 68.3 +- 2.2 % are within one standard error, 95.4 +- 1.0 % within two.
///
/// @param series         (n) samples at constant rate, any unit; at least three must be finite,
///                       these at most kLargestSample in magnitude.  Others (NaN, infinite) are
///                       missing.
/// @param cutoff_period  samples, kShortestCutoff to kLongestCutoff; the only parameter.  NaN is
///                       refused.
/// @return curve, weights and errors, in the unit of the series.
/// @throws std::invalid_argument  too few samples, larger ones, another period, or samples that do
///                                not determine the curve (PenalisedFit) or leave no noise to
///                                measure.
/// Source: penalised_fit.hpp; weights as in F. R. Hampel et al., Robust Statistics, Wiley, 1986,
/// section 2.6 (redescending).  Different here: the bisquare flank.
[[nodiscard]] SmoothTrend smooth(std::span<const double> series, double cutoff_period);

}  // namespace a351::corrector::reading
