#pragma once
/// @file
/// When a verdict may say STABLE, from what only the simulator knows.  Defined before any threshold
/// of the verdict was chosen, and not to be changed to suit one.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "daemon/verdict/live_sample.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/scenario/survey_plan.hpp"

namespace a351::sim {

inline constexpr int kCycleSeconds = 900;       ///< Of the settled oven: no unsteadiness.
inline constexpr int kAheadSeconds = 600;       ///< An occupation's length ...
inline constexpr double kMostChangeMgal = 2.0;  ///< ... in which the error may change by less.
inline constexpr int kQuietSeconds = 60;        ///< Since something touched the box.

enum class Allowed : char { no, yes, unknown };  ///< Unknown: too near to an end of the record.

/// Noise-free error, averaged over one cycle, centred; NaN where half a cycle is missing.
/// @param error_mgal  once a second.
[[nodiscard]] std::vector<double> cycle_mean(std::span<const double> error_mgal);

/// Seconds of the record, from the first to the last one in which the box was touched.
struct Touch {
    double from_s = 0.0, to_s = 0.0;
};

/// For every second: |mean(t + s) - mean(t)| < 2 mGal for all s up to 10 min, and nothing touched
/// the box in the 60 s before.
[[nodiscard]] std::vector<Allowed> allowed(std::span<const double> mean_mgal,
                                           std::span<const Touch> touches);

/// A simulated record as the daemon's live series, with its truth.
struct VerdictRecord {
    UtcTime start;
    std::vector<PlannedSetUp> plan;
    std::vector<daemon::LiveSample> samples;
    std::vector<double> mean_mgal;  ///< cycle_mean() of the temperature error, once a second.
    std::vector<Touch> touches;     ///< Handling, knocks, and the box brought to another place.
    std::vector<Allowed> truth;     ///< Once a second.
};

/// @param switched_on_to  the oven's set point from the start of the record on; before, it was at
///                        the scenario's.
[[nodiscard]] VerdictRecord verdict_record(const Scenario& scenario, std::uint64_t seed,
                                           std::optional<DegC> switched_on_to = std::nullopt);

enum class VerdictCase { warm_up, visit, disturbance };

/// Case `seed` of the many that the verdict is measured on: warm-ups from cold, benchmark visits
/// after drives through changing air, and a settled oven that is knocked about, in turn.
[[nodiscard]] VerdictCase verdict_case(std::uint64_t seed);
[[nodiscard]] VerdictRecord simulated_case(std::uint64_t seed);

}  // namespace a351::sim
