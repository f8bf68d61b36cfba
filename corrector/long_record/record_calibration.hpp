#pragma once
/// @file
/// From two-path fits of long records to the parts of a calibration
/// (corrector/long_record/long_record.md, "Calibration").
///
/// The order for each segment, and then for all:
///
///     if (reason_against_two_paths(t, a, step_s).empty())
///         fits.push_back(fit_two_paths(t, a, step_s, 900.0));
///     const PooledThermal pooled = pool_thermal(fits);
///     calibration.thermal = pooled.response;
///
/// A day or more is needed: a single night determines the fast path only, and a quarter of
/// simulated nights is refused (long_record.md, "Measured").  A segment from power-on must lose its
/// first hours before, because fit_two_paths() assumes equilibrium.

#include <optional>
#include <string>
#include <vector>

#include "corrector/long_record/two_path_fit.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::corrector::long_record {

/// Thermal response from several records together.
///
/// `response` is for the calibration file, the other members are for people.  Values in
/// `parameters` differ from those in `response` because they include the priors.
struct PooledThermal {
    /// Response without the priors of the fits.  Absent: the records determine neither the fast
    /// path nor the static slope.
    std::optional<unit::ThermalResponse> response;
    /// Parameters with the priors of the fits, in the order of kThermalNames; lags in seconds.
    /// `needed` is set if all records together do not determine the parameter.
    std::vector<FittedParameter> parameters;
    double static_slope = 0.0, static_slope_error = 0.0;  ///< rA + rS with priors, mGal/degC.
    bool is_static_slope_determined = false;  ///< Error below half of the prior's deviation.
    /// Probability of the differences between the records by chance, with errors widened by
    /// kThermalErrorFactor; 1 for one record.
    double agreement_p = 1.0;
};

/// Combines fits: their informations (inverse covariances) are added, each without its prior.
///
/// A direction about which all records together contain less information than the prior is not
/// determined.  Its deviation in the response is a hundred times that of the prior, so that it has
/// no effect on a user.
///
/// Drift and warm-up of each record are integrated out.  The order of the fits changes rounding
/// only.  Small agreement_p, below 0.01, means that the unit may have changed between the records:
/// calibrate from each of them alone.
///
/// Accuracy (record_calibration_test.cpp): of 20 simulated units at least 18 are within the 95 %
/// limit of chi-square 5 with errors doubled.  Two equal records halve the variance.
/// @param fits  at least one, each with a positive definite covariance.
[[nodiscard]] PooledThermal pool_thermal(const std::vector<TwoPathFit>& fits);

/// Returns the reason why the two paths cannot be measured from a segment, and the record that is
/// needed; empty if they can be measured.
///
/// The reason is that in no band the acceleration follows the temperature above chance (5 % for all
/// bands together).  Then the fit would take the thermometer's noise for temperature.  The bands
/// are those about a cycle of 900 s.
/// @param temperature_degc   (n) finite, n >= 540.
/// @param acceleration_mgal  (n) finite.
/// @param step_s             time between samples, s.
[[nodiscard]] std::string reason_against_two_paths(const std::vector<double>& temperature_degc,
                                                   const std::vector<double>& acceleration_mgal,
                                                   double step_s);

/// The warm-up in a record.  `words` is a text for people in any case, without a full stop.
struct WarmUpReading {
    std::optional<unit::WarmUpGuidance> guidance;
    /// Result in words; without guidance the reason, and the record that is needed.
    std::string words;
};

/// Returns the time after power-on at which the warm-up that the thermometer does not show is below
/// `within_mgal` and stays there, with one-sided 95 % confidence:
///
///     begins_after + tW ln(|w| / within) + 1.645 x its standard error
///
/// The standard error is by linear propagation of ln(tW) and w with their covariance.  There is no
/// guidance if w or tW is not determined, if |w| is less than twice its error, or if the time is
/// later than the end of the segment.
///
/// If |w| is below the limit from the start, the time is not before the start of the segment.
/// Accuracy: a known exponential comes out within 1e-4 h (record_calibration_test.cpp).
/// @param fit             fit of a segment.
/// @param begins_after_h  time from power-on to the start of the segment, h, >= 0.
/// @param length_h        length of the segment, h.
/// @param within_mgal     limit of the warm-up, mGal, > 0.
[[nodiscard]] WarmUpReading warm_up_guidance(const TwoPathFit& fit, double begins_after_h,
                                             double length_h, double within_mgal);

}  // namespace a351::corrector::long_record
