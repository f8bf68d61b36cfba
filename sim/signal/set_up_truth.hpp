#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/scenario/scenario.hpp"
#include "sim/scenario/survey_plan.hpp"
#include "sim/signal/slow_signal.hpp"

namespace a351::sim {

/// Means over a set-up without its first and last minute (at most a quarter of it each), by the
/// sensor's time.  Gravity, the terms, tilt, bursts and rectification add up to the mean norm of the
/// samples, but for spikes.
struct SetUpTruth {
    double ambient_degc = 0.0;
    double temperature_degc = 0.0;
    std::array<double, kTermCount> terms_mgal{};  ///< By Term.
    double tilt_mgal = 0.0;           ///< What levelling and axis biases do to the norm.
    double burst_mgal = 0.0;          ///< Along the vertical.
    double rectification_mgal = 0.0;  ///< Horizontal mean square over twice gravity.
};

/// Of every occupied set-up of the plan, in its order.
[[nodiscard]] std::vector<SetUpTruth> set_up_truth(const Scenario& scenario,
                                                   const std::vector<PlannedSetUp>& plan,
                                                   std::uint64_t seed);

/// The same as a table, a row per set-up; its columns: sim/truth/truth-format.md.
[[nodiscard]] std::string truth_csv(const Scenario& scenario, const std::vector<PlannedSetUp>& plan,
                                    std::uint64_t seed);

}  // namespace a351::sim
