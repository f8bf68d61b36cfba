#pragma once
/// @file
/// One adjustment of several surveys.  A survey is one unit on one day, with its own record.
///
/// The model of each survey is that of day_model.hpp.  Common to the surveys are:
///
/// - the gravities of the stations;
/// - of a unit, its lags, slopes (also those by an outer oven), axis biases and scale: what a unit is
///   made of;
/// - of the sensors of one box, a part of the placement of each set-up.
///
/// Each survey has its constant, drift, warm-up, steps and noise.  Surveys of different units that
/// were at one station at one time are sensors of one box, or boxes side by side: the share of the
/// placement's variance that they have in common decides, and the readings determine it.
///
///     std::vector<JointSurvey> surveys;                   // one per data root and day
///     const JointFit fit = fit_jointly(surveys);
///     fit.gravity_mgal[3];                                // station 3 of the adjustment
///     fit.system.left_out(3);                             // with its own reference hidden
///
/// Methods and figures: corrector/methods.md, "Several surveys in one adjustment".

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "corrector/whole_day/day_model.hpp"
#include "corrector/whole_day/station_system.hpp"

namespace a351::corrector::whole_day {

/// Returns true for a term that each survey has for itself: constant, drift, warm-up.  The others are
/// of the unit.
[[nodiscard]] constexpr bool is_of_survey(DayTerm term) {
    return term == DayTerm::constant || term == DayTerm::drift || term == DayTerm::warm_up;
}

/// One unit on one day.
struct JointSurvey {
    const reading::DayRecord* record = nullptr;
    std::vector<DayStation> stations;  ///< Stations as in fit_day(), numbered within this survey.
    DayPriors priors;                  ///< Equal for all surveys of a unit.
    /// Number in the adjustment of each number of `stations`.  A gravity that one survey holds is held,
    /// with the same value, in all surveys that have it.
    std::vector<std::size_t> gravities;
    std::size_t unit = 0;  ///< Number of the unit from 0.
};

/// Result of the adjustment for one survey.
struct JointSurveyFit {
    std::array<Estimate, kDayTerms> coefficients;  ///< Those of the unit are equal on all its days.
    std::array<double, 2> lags_s{}, lag_log_errors{};  ///< tF and tS.
    std::vector<Estimate> steps_mgal;
    /// Response of the unit, also on its days without an outer oven.
    std::optional<OuterResponse> outer;
    DayNoise noise;  ///< Most likely; placement of both parts together.
};

/// The share of the placement's variance that the sensors of a box have in common.
struct PlacementShare {
    double most_likely = 0.0;
    double expected = 0.0;               ///< Mean over the likelihood, which the adjustment takes.
    double lowest = 0.0, highest = 1.0;  ///< 95 % limits.
};

/// Result of fit_jointly().
struct JointFit {
    std::vector<JointSurveyFit> surveys;
    std::vector<Estimate> gravity_mgal;   ///< Held or estimated, by number in the adjustment.
    std::optional<PlacementShare> share;  ///< Absent without two sensors at one place and time.
    StationSystem system;                 ///< Holds all gravities, numbered as `gravity_mgal`.
};

/// Fits several surveys together.
///
/// First each survey is fitted alone.  Then lags and noise are searched that make all readings together
/// most likely: in turn the lags and the size of the axis biases of each unit, and placement, flicker
/// and white noise of each survey, until nothing moves by more than 0.02 deviations, at most eight
/// times.  The placement of a box is one number for all its sensors.  As in fit_day(), estimates are
/// those of least squares with the most likely noise, and errors those with the expected one, with the
/// lags to first order.
///
/// The share is searched at 0, 0.1, ... 1, each with the placement and the noise that suit it.  Its
/// most likely value is the least of a parabola through three of them; its limits are where the
/// logarithm of the likelihood is 1.92 below the largest (chi-square of one degree of freedom), so that
/// 0 and 1 may be within them.  The adjustment takes its mean over the likelihood, because the expected
/// variance of either part is linear in it.
///
/// Accuracy (joint_model_test.cpp): one survey gives the gravities of fit_day() within 0.02 mGal and
/// its errors within 3 %; two surveys with nothing in common but a station give its weighted mean.
/// Order: the result depends on the order of the surveys in the last bits only.  Sort them for equal
/// bytes.
/// @param surveys  at least one; each holds a gravity, and each of its set-ups has a bin.
/// Source: R. Thompson, Biometrics 18, 273-289, 1962, and D. A. Harville, J. Am. Stat. Assoc. 72,
/// 320-338, 1977 (variance components by restricted likelihood); S. S. Wilks, Ann. Math. Stat. 9,
/// 60-62, 1938 (limits by the likelihood ratio).
[[nodiscard]] JointFit fit_jointly(const std::vector<JointSurvey>& surveys);

}  // namespace a351::corrector::whole_day
