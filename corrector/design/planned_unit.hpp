#pragma once
/// @file
/// Knowledge of the unit before a survey: priors, noise, course of the oven's temperature.
///
///     PlannedUnit unit = usual_unit();                        // nobody has measured it
///     unit = planned_unit("calibration.toml");                // or result.json of an earlier day

#include <filesystem>
#include <string>

#include "corrector/whole_day/day_priors.hpp"

namespace a351::corrector::design {

/// A unit and its oven, as far as they are known.
struct PlannedUnit {
    whole_day::DayPriors priors;
    whole_day::DayNoise noise;
    /// Random walk of the oven's temperature from stay to stay, degC per square root of an hour.
    double walk_degc_per_sqrt_h = 0.0;
    double tilt_g = 0.0;  ///< Scatter of each horizontal axis' mean from set-up to set-up.
    std::string origin;   ///< Source of the numbers, in words.
};

/// Temperature of the oven on the published survey day: rms of (change)^2 / time between
/// neighbouring readings, degC per square root of an hour.  Source: observations.csv of
/// tests/golden/tsukuba (planned_day_test.cpp).
inline constexpr double kUsualWalk_degc_per_sqrt_h = 0.116;

/// Scatter of the levelling, 0.1 deg as a part of g.  Reason: the resolution of a box level; an
/// assumption.
inline constexpr double kUsualTilt_g = 0.0017;

/// Returns a unit of which nothing is known: the usual priors, kUsualNoise, the oven of the published
/// survey day.
[[nodiscard]] PlannedUnit usual_unit();

/// Reads a unit from a calibration (TOML), or from the result.json of a day corrected with the
/// whole-day model.
///
/// - calibration.toml: the priors that a survey with this calibration has (day_priors_of()).
/// - result.json: response and axis biases with their covariance, noise, temperature walk and
///   scatter of the levelling of that day.  Placement and flicker are the roots of their expected
///   variances, as in the uncertainties of a day.
/// @throws InputError  the file cannot be read, is neither of both, or was not made by this model.
[[nodiscard]] PlannedUnit planned_unit(const std::filesystem::path& file);

}  // namespace a351::corrector::design
