#pragma once
/// @file
/// Defines when a verdict may be STABLE, from values that only the simulator knows.  The definition
/// was made before any threshold of the verdict was chosen, and must not be changed to suit a
/// threshold.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "daemon/verdict/live_sample.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/scenario/survey_plan.hpp"

namespace a351::sim {

/// Period of the settled oven's cycle in s; the cycle itself does not count as a change.
inline constexpr int kCycleSeconds = 900;
inline constexpr int kAheadSeconds = 600;  ///< Length of an occupation in s.
/// Limit in mGal for the change of the error within kAheadSeconds.
inline constexpr double kMostChangeMgal = 2.0;
inline constexpr int kQuietSeconds = 60;  ///< Time in s that must have passed since the last touch.

enum class Allowed : char { no, yes, unknown };  ///< Unknown: too near to an end of the record.

/// Returns the noise-free error averaged over one centred cycle; NaN where half a cycle is missing.
/// @param error_mgal  error without noise, once a second
[[nodiscard]] std::vector<double> cycle_mean(std::span<const double> error_mgal);

/// Time in which the box was touched, in s since the start of the record.
struct Touch {
    double from_s = 0.0, to_s = 0.0;
};

/// Returns for every second whether STABLE is allowed: |mean(t + s) - mean(t)| < 2 mGal for all s
/// up to 10 min, and nothing touched the box in the 60 s before.
[[nodiscard]] std::vector<Allowed> allowed(std::span<const double> mean_mgal,
                                           std::span<const Touch> touches);

/// A simulated record as the daemon's live series, with its truth.
struct VerdictRecord {
    UtcTime start;
    std::vector<scenario::PlannedSetUp> plan;
    std::vector<daemon::verdict::LiveSample> samples;
    std::vector<double> mean_mgal;  ///< cycle_mean() of the temperature error, once a second.
    std::vector<Touch> touches;     ///< Handling, knocks, and transport to another place.
    std::vector<Allowed> truth;     ///< Result of allowed(), once a second.
};

/// Simulates a record.
/// @param switched_on_to  set point of the oven from the start of the record on; before the start
///                        it was that of the scenario
[[nodiscard]] VerdictRecord verdict_record(const scenario::Scenario& scenario, std::uint64_t seed,
                                           std::optional<DegC> switched_on_to = std::nullopt);

enum class VerdictCase { warm_up, visit, disturbance };

/// Returns the kind of the test case `seed`.  The kinds alternate: warm-ups from cold, benchmark
/// visits after drives through air of changing temperature, and a settled oven that is knocked.
[[nodiscard]] VerdictCase verdict_case(std::uint64_t seed);
[[nodiscard]] VerdictRecord simulated_case(std::uint64_t seed);

}  // namespace a351::sim
