#pragma once
/// @file
/// Allan deviation of a series, its limits, and the three noises that it shows.

#include <cstddef>
#include <vector>

#include "corrector/noise/limits.hpp"

namespace a351::corrector::noise {

/// White noise, flicker and random walk.  They make the Allan variance of averages over t
///
///     sigma^2(t) = white^2 / t + (2 ln 2 / pi) flicker^2 + walk^2 t / 3
///
/// and the one-sided power spectral density 2 white^2 + flicker^2 / (pi f) + walk^2 / (2 pi^2 f^2).
struct ThreeNoises {
    Limits white_mgal_sqrt_s;  ///< Deviation of an average of 1 s.  An upper limit may be infinite.
    Limits flicker_mgal;
    Limits walk_mgal_per_sqrt_s;
    /// False: something else is in the record, as a cycle of the oven.  Then the levels are only those
    /// that are nearest, and neither they nor the deviations have limits.
    bool describes_record = false;

    /// Returns the Allan deviation, mGal.
    [[nodiscard]] double deviation_mgal(double averaging_s) const;
    /// Returns the one-sided power spectral density, mGal^2/Hz.
    [[nodiscard]] double density_mgal2_per_hz(double frequency_hz) const;
};

/// Allan deviation of averages over one time, as measured and by the three noises.
struct AllanPoint {
    double averaging_s = 0.0;
    Limits deviation_mgal;
    double model_mgal = 0.0;
};

struct AllanAnalysis {
    std::vector<AllanPoint> points;  ///< Averages of 1, 2, 4 ... samples up to n / 4.
    ThreeNoises noises;
};

/// Returns the overlapping Allan deviation, and the three noises that fit it best.
///
/// The squares of the noises are fitted to the variances by least squares with the covariance of
/// these, which follows from the noises; none is negative.  It comes from the second differences of
/// the sums of the samples, which are Gaussian:
///
///     cov(sigma^2_m, sigma^2_l) = 1/2 mean over i, k of r_ml(k - i)^2
///     r_ml(j) = sum over a, b in 0..2 of c_a c_b s(j + b l - a m) / (m l),  c = 1, -2, 1
///     s(k) = - white |k| / 2 + flicker k^2 ln |k| / (2 pi) + walk |k|^3 / 12  (squares, per sample)
///
/// The limits of a deviation are those of chi-square with the degrees of freedom that have this
/// variance.  A cycle of the oven is not noise, but raises the deviation at its times too:
/// where the sum of the squared misfits has a probability below 0.001, the noises are fitted to the
/// ratio of model and measured variance, weighted by the number of independent averages.
///
/// Accuracy (allan_deviation_test.cpp): of 500 records each of white noise, flicker, walk and their sum,
/// 1024 samples each, 93 to 98 % of the limits of each deviation contain the truth, 95.1 % of all, and
/// 92 to 98 % of those of each noise.  0.7 % of these records are not described.
/// The upper limit of the noise that dominates is 1.05 (white) to 1.2 (walk) times the truth; a walk below white noise
/// often has none, because the error grows with it.
/// @param values  (n) mGal, finite, n >= 64.
/// @param step_s  time between samples.
/// Source: C. A. Greenhall and W. J. Riley, Uncertainty of stability variances based on finite
/// differences, Proc. 35th PTTI Meeting, 2003, equations for s and the variance; W. J. Riley, Handbook
/// of Frequency Stability Analysis, NIST SP 1065, 2008; the names of the noises are those of
/// IEEE Std 952-1997, annex C.
[[nodiscard]] AllanAnalysis analyse_allan(const std::vector<double>& values, double step_s);

/// Returns that of several series of one noise, for example of stays: the variances are means over all
/// differences, none of which reaches from one series to the next, and their covariance is that of
/// independent series.
/// @param parts  finite, the longest with at least 4 samples.  A part counts for averages up to a quarter
///               of it.
[[nodiscard]] AllanAnalysis pooled_allan(const std::vector<std::vector<double>>& parts,
                                         double step_s);

/// Returns the overlapping Allan deviation of averages over m = `samples` neighbours, in the unit
/// of the values:
///
///     sigma^2 = 1/2 mean over i of (y[i + m] - y[i])^2,  y[i] = mean of x[i] ... x[i + m - 1]
///
/// Accuracy: a ramp gives slope x m / sqrt(2), samples of +-1 in turn give sqrt(2) for m = 1 and 0
/// for m = 2 (apply_calibration_test.cpp).
///
/// Cost: O(n), whatever m.  The mean is subtracted first, so that the level of the record costs no
/// digits of the sums.  A NaN gives NaN.
/// @param values   x (n) finite, n >= 2 m.
/// @param samples  m >= 1.
/// Source: D. W. Allan, Proc. IEEE 54, 221-230, 1966; overlapping: W. J. Riley, NIST SP 1065, 2008,
/// 5.2.4.
[[nodiscard]] double allan_deviation(const std::vector<double>& values, std::size_t samples);

/// Returns the rms difference of averages over `samples` that begin `apart` samples from each other,
/// divided by sqrt(2).  With `apart` = `samples` it is the Allan deviation.
[[nodiscard]] double scatter_apart(const std::vector<double>& values, std::size_t samples,
                                   std::size_t apart);

}  // namespace a351::corrector::noise
