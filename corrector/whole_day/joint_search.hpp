#pragma once
/// @file
/// Search for the most likely lags and noise of an adjustment, and for its share of the placement.

#include <optional>

#include "corrector/whole_day/joint_problem.hpp"

namespace a351::corrector::whole_day {

/// The point of least cost, and the share with its limits if there is a box.
struct JointSearch {
    JointPoint most_likely;  ///< The point of least cost, but with the expected share.
    /// The same with the roots of the expected variances, as DayProblem::expected().
    JointPoint expected;
    std::optional<PlacementShare> share;
};

/// Searches as fit_jointly() says.
/// @param start  for example the points of the surveys alone.
[[nodiscard]] JointSearch search(const JointProblem& problem, JointPoint start);

}  // namespace a351::corrector::whole_day
