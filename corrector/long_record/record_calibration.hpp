#pragma once
/// @file
/// From two-path fits of long records to the parts of a calibration
/// (corrector/long_record/long_record.md, "Calibration").

#include <optional>
#include <string>
#include <vector>

#include "corrector/long_record/two_path_fit.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::corrector {

struct PooledThermal {
    /// Without what the fits believed beforehand.  Absent: the records determine neither the fast path
    /// nor the static slope.
    std::optional<ThermalResponse> response;
    /// In the order of kThermalNames: with the fits' priors, the lags in seconds; `needed` where the
    /// records together leave the parameter open.
    std::vector<FittedParameter> parameters;
    double static_slope = 0.0, static_slope_error = 0.0;  ///< rA + rS, mGal/degC, likewise.
    bool is_static_slope_determined = false;
    /// Of the records among each other, errors widened as a survey does; 1 for one record.
    double agreement_p = 1.0;
};

/// The records together: informations (inverse covariances) are added, each without its prior.
///
/// Directions about which all of them together say less than the prior are not passed on: there the
/// covariance has a hundred times the prior's deviation, which is nothing to any user.
/// @param fits  at least one.
[[nodiscard]] PooledThermal pool_thermal(const std::vector<TwoPathFit>& fits);

/// Why the two paths cannot be measured from a segment, and what record would do; empty: they can.  In no
/// band does the acceleration follow the temperature above chance (5 % for all bands together): the
/// fit would take the thermometer's noise for temperature.
/// @param temperature_degc, acceleration_mgal  (n), n >= 540.
[[nodiscard]] std::string lacks_response(const std::vector<double>& temperature_degc,
                                         const std::vector<double>& acceleration_mgal,
                                         double step_s);

/// What a record tells of the warm-up.
struct WarmUpReading {
    std::optional<WarmUpGuidance> guidance;
    std::string
        words;  ///< What was found, or why there is no guidance and what record would give it.
};

/// The time after power-on at which the warm-up that the thermometer does not show has fallen below
/// `within_mgal` for good, with one-sided 95 % confidence.
/// @param begins_after_h  of the fitted segment, after power-on, >= 0.
/// @param length_h        of the segment: nothing is claimed beyond its end.
[[nodiscard]] WarmUpReading warm_up_guidance(const TwoPathFit& fit, double begins_after_h,
                                             double length_h, double within_mgal);

}  // namespace a351::corrector
