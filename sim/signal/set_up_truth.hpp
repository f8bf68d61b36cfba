#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/scenario/scenario.hpp"
#include "sim/scenario/survey_plan.hpp"
#include "sim/signal/slow_signal.hpp"

namespace a351::sim::signal {

/// Means over a set-up without its first and last minute (at most a quarter of it each), by the
/// sensor's time.  Gravity, the terms, tilt, bursts and rectification add up to the mean norm of
/// the samples, apart from spikes.
struct SetUpTruth {
    double ambient_degc = 0.0;
    double temperature_degc = 0.0;
    std::array<double, kTermCount> terms_mgal{};  ///< Indexed by Term.
    double tilt_mgal = 0.0;           ///< Effect of levelling and axis biases on the norm.
    double burst_mgal = 0.0;          ///< Along the vertical.
    double rectification_mgal = 0.0;  ///< Horizontal mean square over twice gravity.
};

/// Returns the means of every occupied set-up, in the order of the plan.
[[nodiscard]] std::vector<SetUpTruth> set_up_truth(const scenario::Scenario& scenario,
                                                   const std::vector<scenario::PlannedSetUp>& plan,
                                                   std::uint64_t seed);

/// Returns them as a table with a row per set-up; columns: sim/truth/truth-format.md.
[[nodiscard]] std::string truth_csv(const scenario::Scenario& scenario,
                                    const std::vector<scenario::PlannedSetUp>& plan,
                                    std::uint64_t seed);

}  // namespace a351::sim::signal
