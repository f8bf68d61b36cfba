#pragma once

#include <cstdint>
#include <vector>

#include "sim/scenario/scenario.hpp"
#include "sim/scenario/survey_plan.hpp"

namespace a351::sim {

/// Returns the plan with its limits converted from the sensor's time, in which a scenario is
/// written, to UTC.  With a true clock the plan is unchanged.
[[nodiscard]] std::vector<PlannedSetUp> by_true_time(const Scenario& scenario,
                                                     const std::vector<PlannedSetUp>& plan,
                                                     std::uint64_t seed);

}  // namespace a351::sim
