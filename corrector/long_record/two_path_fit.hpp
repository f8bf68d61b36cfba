#pragma once
/// @file
/// The two paths from temperature to acceleration, fitted to one segment:
///
///     a = c + d t + w exp(-t / tW) + rA (T - T0) + rF (T - lag(T, tF)) / tF + rS (lag(T, tS) - T0)
///         + oA To + oS lag(To, tO)
///
/// a is in mGal, T in degC, t in h, rF in mGal/(degC/h), tF, tS and tW in s.
/// - To: temperature of an outer oven, if there is one; oA and oS in mGal/degC, tO in s.
/// - rA, rF, rS, lag(T, tau): the unit's thermal response (protocol/unit/thermal_response.hpp), in
///   equilibrium at the start of the segment.
/// - w: warm-up that the thermometer does not see, at the start of the segment.
///
/// Methods and figures: corrector/long_record/long_record.md, "Two paths" and "Measured".
///
///     const TwoPathFit fit = fit_two_paths(t, a, 20.0, 900.0);
///     const FittedParameter& fast = fit[TwoPathTerm::fast];
///     if (fast.is_determined) use(fast.value, fast.standard_error);
///     else ask_for(fast.needed);
///
/// A value that is not determined is mostly its prior.  Do not extrapolate a fit with `unexplained`
/// bands: the response of the unit is then not that of two first-order lags.

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "corrector/long_record/response.hpp"
#include "protocol/text/message.hpp"
#include "protocol/unit/thermal_response.hpp"

namespace a351::corrector::long_record {

/// Parameters d, w, rA, rF, rS, tF, tS, tW, in the order of TwoPathFit::parameters and its
/// covariance.
/// - `drift`: d, mGal/h; `warm_up`: w, mGal, at the start of the segment.
/// - `level`: rA, mGal/degC; `fast`: rF, mGal/(degC/h); `slow`: rS, mGal/degC.
/// - `fast_lag`: tF, `slow_lag`: tS, `warm_up_time`: tW, all in s.
enum class TwoPathTerm { drift, warm_up, level, fast, slow, fast_lag, slow_lag, warm_up_time };
/// Number of parameters.
inline constexpr std::size_t kTwoPathTerms = 8;

/// Parameters that a calibration keeps, in the order of ThermalTerm.
inline constexpr std::array kThermalOfTwoPath{TwoPathTerm::level, TwoPathTerm::slow,
                                              TwoPathTerm::fast, TwoPathTerm::fast_lag,
                                              TwoPathTerm::slow_lag};
static_assert(kThermalOfTwoPath.size() == unit::kThermalTerms);

/// Greatest standard error of a determined parameter, in deviations of its prior.  Reason: the
/// record then halves the uncertainty that there was before.
inline constexpr double kDeterminedDeviation = 0.5;

/// An estimated parameter.
///
/// `value` and `standard_error` are in `unit` and include the prior.  For a lag or time the error
/// is value x error of its natural logarithm.  `name` is for people.
struct FittedParameter {
    std::string key;        ///< Key with its unit, as in result.json.
    const char* name = "";  ///< A text of the catalogue.
    std::string unit;
    double value = 0.0;
    double standard_error = 0.0;
    bool is_determined = false;  ///< True: the standard error is below half of the prior's.
    text::Message needed;        ///< Record that would determine it; empty if it is determined.
};

/// Result of fit_two_paths().
///
/// The constant c is no parameter: the residual has no mean.  The sum rA + rS is often determined
/// where its parts are not, because a record shows them apart only by the slow lag.
struct TwoPathFit {
    /// In the order of TwoPathTerm; with an outer oven then oA, oS and tO.
    std::vector<FittedParameter> parameters;
    /// (kTwoPathTerms, kTwoPathTerms) Covariance of the coefficients in their units, and of the
    /// natural logarithms of lags and times.
    Eigen::MatrixXd covariance;
    double static_slope = 0.0, static_slope_error = 0.0;  ///< rA + rS, mGal/degC.
    /// True: static_slope_error is below half of the prior standard deviation of rA + rS.
    bool is_static_slope_determined = false;
    double residual_rms_mgal = 0.0;     ///< Rms of `residual_mgal`.
    std::vector<double> residual_mgal;  ///< (n) Residual minus its mean.
    /// Bands in which the residual still follows the temperature, at 5 % for all bands together.
    std::vector<ResponsePoint> unexplained;

    /// Returns a parameter; valid as long as the fit exists.
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
/// - oA and oS 0, 60 mGal/degC
///
/// Log-normal priors, median and factor: tF 43 s, 2; tS 2700 s, 2; tW 2.5 h, 1.5; tO 1200 s, 2.
///
/// - The thermometer's white noise is measured between 70 and 110 s, where the acceleration does not
///   follow the temperature.  Each frequency of the
///   regressors is multiplied by the share of its power that is not noise; below three times the
///   noise by 0.
/// - The noise of the fit is the spectrum of the residuals, smoothed in half octaves, in four
///   rounds.  At the eight lowest frequencies it is at least 1/f from the frequencies above,
///   because the slow columns absorb part of the power there.
/// - A parameter is determined if its standard error is below half of the prior's.
///
/// Accuracy (two_path_fit_test.cpp): on 20 simulated nights, 95 % limits of every parameter contain
/// the true value in at least 17.  White noise instead of a temperature determines no path.
/// The errors of a week are smaller than those of a night; it determines the static slope.
///
/// For rA, rF, rS and their lags the segment must begin in equilibrium: remove the first hours
/// after power-on.  For w and tW keep them.  The spectra use the first samples, up to a length that
/// is fast to transform; the residual is of all n.  Deterministic.
/// @param temperature_degc   (n) finite, n >= 540.
/// @param acceleration_mgal  (n) finite.
/// @param step_s             time between samples, s.
/// @param cycle_s            cycle of the oven, s, for the bands of the residual test.
/// @param outer_degc         (n) temperature of an outer oven, finite; empty: there is none.
/// Source: P. Whittle, J. R. Stat. Soc. B 15, 125-139, 1953.
[[nodiscard]] TwoPathFit fit_two_paths(const std::vector<double>& temperature_degc,
                                       const std::vector<double>& acceleration_mgal, double step_s,
                                       double cycle_s, const std::vector<double>& outer_degc = {});

}  // namespace a351::corrector::long_record
