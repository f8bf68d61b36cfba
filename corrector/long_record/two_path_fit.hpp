#pragma once
/// @file
/// The two paths from temperature to acceleration, fitted to one segment:
///
///     a = c + d t + w exp(-t / tW) + rA (T - T0) + rF (T - lag(T, tF)) / tF + rS (lag(T, tS) - T0)
///
/// a is in mGal, T in degC, t in h, rF in mGal/(degC/h), tF, tS and tW in s.
/// - lag(T, tau): T behind a first-order lag, in equilibrium at the start of the segment.
/// - rA: rest of the thermometer's compensation.
/// - rF: crystals that feel a change before the thermometer.
/// - rS: an oscillator that feels a change later.
/// - w: warm-up that the thermometer does not see, at the start of the segment.
///
/// Methods and figures: corrector/long_record/long_record.md, "Two paths" and "Measured".

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "corrector/long_record/response.hpp"

namespace a351::corrector {

/// Parameters d, w, rA, rF, rS, tF, tS, tW, in the order of TwoPathFit::parameters and its
/// covariance.
enum class TwoPathTerm { drift, warm_up, level, fast, slow, fast_lag, slow_lag, warm_up_time };
/// Number of parameters.
inline constexpr std::size_t kTwoPathTerms = 8;

/// Parameters that a calibration keeps, in the order of kThermalNames.
inline constexpr std::array<TwoPathTerm, 5> kThermalTerms{TwoPathTerm::level, TwoPathTerm::slow,
                                                          TwoPathTerm::fast, TwoPathTerm::fast_lag,
                                                          TwoPathTerm::slow_lag};

/// Greatest standard error of a determined parameter, in deviations of its prior.
inline constexpr double kDeterminedDeviation = 0.5;

/// An estimated parameter.
struct FittedParameter {
    std::string key;  ///< Key with its unit, as in result.json.
    std::string name;
    std::string unit;
    double value = 0.0;
    double standard_error = 0.0;
    bool is_determined = false;  ///< True: the standard error is below half of the prior's.
    std::string needed;          ///< Record that would determine it; empty if it is determined.
};

/// Normal prior of a parameter in its unit; for lags and times of the natural logarithm of seconds.
/// The priors are independent.
struct TwoPathPrior {
    double mean = 0.0;
    double deviation = 0.0;
};
/// Returns the prior of a parameter, as listed at fit_two_paths().
[[nodiscard]] TwoPathPrior two_path_prior(TwoPathTerm term);

/// Result of fit_two_paths().
struct TwoPathFit {
    std::array<FittedParameter, kTwoPathTerms> parameters;
    /// (kTwoPathTerms, kTwoPathTerms) Covariance of the coefficients in their units, and of the
    /// natural logarithms of lags and times.
    Eigen::MatrixXd covariance;
    double static_slope = 0.0, static_slope_error = 0.0;  ///< rA + rS, mGal/degC.
    bool is_static_slope_determined = false;              ///< As FittedParameter::is_determined.
    double residual_rms_mgal = 0.0;                       ///< Rms of `residual_mgal`.
    std::vector<double> residual_mgal;                    ///< (n) Residual minus its mean.
    /// Bands in which the residual still follows the temperature, at 5 % for all bands together.
    std::vector<ResponsePoint> unexplained;

    /// Returns a parameter.
    [[nodiscard]] const FittedParameter& operator[](TwoPathTerm term) const {
        return parameters.at(static_cast<std::size_t>(term));
    }
};

/// Fits the two paths to a segment.
///
/// Coefficients: generalised least squares with priors, by frequency (Whittle's likelihood), at
/// periods from 240 s on.  Lags and times: largest restricted likelihood times their priors.
/// Standard errors: posterior covariance, with lags and times to first order.
///
/// Priors, mean and standard deviation:
/// - d 0, 1 mGal/h; w 0, 60 mGal; rA and rS 0, 60 mGal/degC; rF 0, 30 mGal/(degC/h)
///
/// Log-normal priors, median and factor: tF 43 s, 2; tS 2700 s, 2; tW 2.5 h, 1.5.
///
/// - The thermometer's white noise is measured between 70 and 110 s.  Each frequency of the
///   regressors is multiplied by the share of its power that is not noise; below three times the
///   noise by 0.
/// - The noise of the fit is the spectrum of the residuals, smoothed in half octaves, in four
///   rounds.  At the eight lowest frequencies it is at least 1/f from the frequencies above,
///   because the slow columns absorb part of the power there.
/// - A parameter is determined if its standard error is below half of the prior's.
///
/// Accuracy (two_path_fit_test.cpp): on 20 simulated nights, 95 % limits of every parameter contain
/// the true value in at least 17.  White noise instead of a temperature determines no path.
/// @param temperature_degc   (n) finite, n >= 540.
/// @param acceleration_mgal  (n) finite.
/// @param step_s             time between samples, s.
/// @param cycle_s            cycle of the oven, s, for the bands of the residual test.
/// Source: P. Whittle, J. R. Stat. Soc. B 15, 125-139, 1953.
[[nodiscard]] TwoPathFit fit_two_paths(const std::vector<double>& temperature_degc,
                                       const std::vector<double>& acceleration_mgal, double step_s,
                                       double cycle_s);

}  // namespace a351::corrector
