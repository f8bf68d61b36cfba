#pragma once
/// @file
/// Search for the most likely lags and noise of an adjustment, and for the share of the placement that
/// the sensors of a box have in common.

#include <array>
#include <optional>
#include <vector>

#include "corrector/whole_day/day_problem.hpp"

namespace a351::corrector::whole_day {

/// The share of the placement's variance that the sensors of a box have in common.
struct PlacementShare {
    double most_likely = 0.0;
    double expected = 0.0;               ///< Mean over the likelihood, which the adjustment takes.
    double lowest = 0.0, highest = 1.0;  ///< Nominal 95 % limits.
};

/// What is found.
struct DaySearch {
    DayPoint most_likely;  ///< The point of least cost, but with the expected share.
    /// The same with the roots of the expected variances of placements, flicker, axis biases and an outer
    /// oven's effect.  They are larger than the most likely ones, because the distribution is skew.  It
    /// is taken as log-normal, with the variance from the curvature of the cost with the other numbers
    /// held, at least that of the prior, 1.
    DayPoint expected;
    std::optional<PlacementShare> share;  ///< Absent without a box.
    /// Standard errors of the logarithms of placement, flicker and white noise of a single survey, from
    /// the curvature of the cost with the other numbers held; absent if it has no minimum there.
    std::optional<std::array<double, 3>> noise_log_errors;
    /// Standard errors of the shares of the scale in deviations, from the curvature of the cost; 0 for
    /// all other numbers.  Empty if nothing was searched.
    std::vector<double> u_errors = {};
};

/// Searches all numbers of a single survey at once.
///
/// It evaluates the cost at most 2000 times and does not report if this was too few.  It ends within
/// 0.001 deviations; from nearby within 0.01, which moves a gravity by about 0.01 of its
/// uncertainty: by at most 0.016 mGal in tests/bench/survey_accuracy.py 97104.
/// @param nearby  start of the search; null: the priors' medians, with the size of the axis biases of
///                0, 2 and 4 deviations that has the least cost.
[[nodiscard]] DaySearch search_alone(const DayProblem& problem, const SurveyPoint* nearby);

/// Searches several surveys in turn: the lags and the size of the axis biases of each unit, the
/// placement of each group, and flicker and white noise of each survey.  This is repeated until
/// nothing moves by more than 0.02 standard deviations, at most eight times.
///
/// The share is searched at 0, 0.1, ... 1, each with its best placement and noise.  Its most likely
/// value is the least of a parabola through three of them.  At its limits the logarithm of this
/// likelihood is 1.92 below the largest (chi-square of one degree of freedom), so that 0 and 1 may
/// be within them.  On simulated boxes they contain the share on 92 to 100 % of the days
/// (accuracy.md).  The adjustment takes the mean of the share over the likelihood, because the
/// expected variance of either part is linear in it.
/// @param start  for example the points of the surveys alone.
[[nodiscard]] DaySearch search_together(const DayProblem& problem, DayPoint start);

/// Returns the point at which each number is the mean over the surveys.
/// @param parts  one for each survey.
[[nodiscard]] DayPoint mean_point(const DayProblem& problem, const std::vector<SurveyPoint>& parts);

}  // namespace a351::corrector::whole_day
