#pragma once
/// @file
/// The two paths from temperature to acceleration, fitted to one segment:
///
///     a = c + d t + w exp(-t / tW) + rA (T - T0) + rF (T - lag(T, tF)) / tF + rS (lag(T, tS) - T0)
///
/// lag: first order, in equilibrium at the begin.  rA: what the thermometer's compensation leaves; rF:
/// crystals that feel a change before the thermometer; rS: an oscillator that feels it later; w: warm-up
/// that the thermometer does not see.

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "corrector/long_record/response.hpp"

namespace a351::corrector {

/// Places in TwoPathFit::parameters and its covariance.
enum class TwoPathTerm { drift, warm_up, level, fast, slow, fast_lag, slow_lag, warm_up_time };
inline constexpr std::size_t kTwoPathTerms = 8;

/// What a calibration keeps of them, in the order of kThermalNames.
inline constexpr std::array<TwoPathTerm, 5> kThermalTerms{TwoPathTerm::level, TwoPathTerm::slow,
                                                          TwoPathTerm::fast, TwoPathTerm::fast_lag,
                                                          TwoPathTerm::slow_lag};

/// Of the prior's deviation: a parameter that is known better is determined.
inline constexpr double kDeterminedDeviation = 0.5;

struct FittedParameter {
    std::string key;  ///< With its unit, as in result.json.
    std::string name;
    std::string unit;
    double value = 0.0;
    double standard_error = 0.0;
    bool is_determined = false;  ///< The record halves what the prior leaves open.
    std::string needed;          ///< Otherwise: what record would.
};

/// What the fit believes of a term before it sees a record; of lags and times the natural logarithm of
/// seconds.  The terms are independent.
struct TwoPathPrior {
    double mean = 0.0;
    double deviation = 0.0;
};
[[nodiscard]] TwoPathPrior two_path_prior(TwoPathTerm term);

struct TwoPathFit {
    std::array<FittedParameter, kTwoPathTerms> parameters;
    /// (kTwoPathTerms, kTwoPathTerms): of the coefficients in their units, of the logarithms of the lags.
    Eigen::MatrixXd covariance;
    double static_slope = 0.0, static_slope_error = 0.0;  ///< rA + rS, mGal/degC.
    bool is_static_slope_determined = false;              ///< As of a parameter.
    double residual_rms_mgal = 0.0;
    std::vector<double> residual_mgal;  ///< (n) less its mean.
    /// Bands in which the residual still follows the temperature, at 5 % for all together.
    std::vector<ResponsePoint> unexplained;

    [[nodiscard]] const FittedParameter& operator[](TwoPathTerm term) const {
        return parameters.at(static_cast<std::size_t>(term));
    }
};

/// Generalised least squares by frequency (Whittle's likelihood) at periods from 240 s on, the lags by
/// the largest restricted likelihood times their priors.
///
/// The thermometer's white noise, as it stands between 70 and 110 s, is kept out of the regressors by the
/// share of it in each frequency's power; below three times that noise a frequency does not count.  The
/// noise of the fit is the smoothed spectrum of the residuals, in half octaves and by repetition; at the
/// eight lowest frequencies, whose power the slow columns take for themselves, at least what 1/f from
/// the frequencies above would have.  Priors (mean, standard deviation): d 0, 1 mGal/h; w 0, 60 mGal; rA
/// and rS 0, 60 mGal/degC; rF 0, 30 mGal/(degC/h).  Log-normal: tF 43 s and tS 2700 s, factor 2; tW 2.5 h,
/// factor 1.5.  A parameter whose standard error is more than half of the prior's is not determined.
///
/// @param temperature_degc, acceleration_mgal  (n), n >= 540.
/// @param cycle_s  for the bands of the residual test.
/// Source: P. Whittle, J. R. Stat. Soc. B 15, 125-139, 1953.  two_path_fit_test.cpp counts how often
/// the limits hold.
[[nodiscard]] TwoPathFit fit_two_paths(const std::vector<double>& temperature_degc,
                                       const std::vector<double>& acceleration_mgal, double step_s,
                                       double cycle_s);

}  // namespace a351::corrector
