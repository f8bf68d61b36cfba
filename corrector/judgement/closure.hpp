#pragma once
/// @file
/// Closures: differences between two readings of one station.  Without noise, drift and temperature
/// effects they would be 0.
///
/// Closures need no reference gravity.  They show how readings scatter and drift, and how much of
/// it each correction removes:
///
///     const std::vector<Closure> closures = close_stations(result);
///     compare(rms_of(closures, &Closure::before), rms_of(closures, &Closure::after_rate));
///
/// The coefficients were fitted to the same readings, so the last differences are in sample.

#include <cstddef>
#include <optional>
#include <vector>

#include "corrector/model/corrected_survey.hpp"

namespace a351::corrector::judgement {

/// The difference `later` minus `earlier` of two readings of one station, after each correction.
///
/// Each difference includes the steps before it.  The constant of the model cancels.  `after_rate`
/// has the tilt correction too, so that a difference by tilt does not count as drift
/// (closure_test.cpp).
struct Closure {
    std::size_t earlier = 0;  ///< Index into the rows.
    std::size_t later = 0;    ///< Index into the rows, greater than `earlier`.
    double hours = 0.0;       ///< Time between the readings, h.
    MilliGal before;          ///< Difference without any correction.
    MilliGal after_tide, after_temperature, after_rate;
    MilliGal after_all;  ///< After drift and all other corrections of the model.
    /// Drift that would explain after_rate, mGal/h: after_rate / hours, positive if readings grow.
    /// Absent between set-ups of one stay, which are too close in time.
    std::optional<double> drift_mgal_per_h;
};

/// Returns all pairs of readings of each station, stations in the order of their first reading,
/// pairs in order of time.  Each set-up of a stay is a reading.
///
/// All rows take part, in the fit or not.  A station of m readings gives m (m - 1) / 2 pairs; one
/// that was read once gives none.
/// @param result  rows in strictly ascending time.
[[nodiscard]] std::vector<Closure> close_stations(const model::SurveyCorrection& result);

/// Returns the root mean square of a difference over all pairs, about 0; the divisor is the number of
/// pairs.  Pairs of one station share readings, so a station that was read often has a large weight.
/// @param closures  at least one.
[[nodiscard]] MilliGal rms_of(const std::vector<Closure>& closures, MilliGal Closure::*difference);

}  // namespace a351::corrector::judgement
