#pragma once

#include <cstdint>
#include <vector>

#include "sim/scenario/scenario.hpp"
#include "sim/scenario/survey_plan.hpp"

namespace a351::sim {

/// The plan with its limits turned from the sensor's time, by which a scenario runs, into UTC: the
/// same where the clock is true.
[[nodiscard]] std::vector<PlannedSetUp> by_true_time(const Scenario& scenario,
                                                     const std::vector<PlannedSetUp>& plan,
                                                     std::uint64_t seed);

}  // namespace a351::sim
