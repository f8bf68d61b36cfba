#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/core/units.hpp"
#include "sim/noise/noise.hpp"
#include "sim/plant/lag.hpp"
#include "sim/plant/ovens.hpp"
#include "sim/plant/temperature_error.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/scenario/survey_plan.hpp"
#include "sim/signal/cool_box.hpp"

namespace a351::sim::signal {

/// Terms by which the reading differs from gravity.
enum class Term : std::size_t {
    tide,
    bias,
    crystal_static,
    crystal_dynamic,
    clock,
    warm_up,
    placement,
    flicker,
    resonant,
    white,
    drift,
    ripple,
    scale,
    outer_oven,
    turn
};
inline constexpr std::size_t kTermCount = 15;

/// The slow signals at one instant.
struct SlowValue {
    MilliGal along_vertical;  ///< Gravity, tide, ripple, and the errors of the scale.
    MilliGal along_z;         ///< The errors of the bias, on axis z in any face.
    DegC temperature;         ///< Reported by the sensor, without the white noise of the samples.
    DegC ambient;             ///< Air inside the cool box.
    std::size_t set_up = 0;   ///< Index in the plan of the set-up in effect.
    /// Indexed by Term: their effects on the reading.  An error of the bias has the other sign in the
    /// other face.
    std::array<double, kTermCount> terms_mgal{};
};

/// Gravity, tide, temperature error, drift, slow noise and ripple: one value a second.  The n-th
/// value, n = 0, 1, ..., belongs to the start of the record + n s.
class SlowSignal {
public:
    static constexpr double kStepSeconds = plant::ThermalPlant::kStepSeconds;

    SlowSignal(const scenario::Scenario& scenario, const std::vector<scenario::PlannedSetUp>& plan,
               std::uint64_t seed);

    [[nodiscard]] SlowValue next();

    /// Returns the plant; a setting made there changes the values from the next one on.
    [[nodiscard]] plant::OvenPlant& oven() noexcept { return ovens_.inner(); }
    /// Returns that of the outer oven; null if there is none.
    [[nodiscard]] plant::OvenPlant* outer_oven() noexcept { return ovens_.outer(); }

private:
    [[nodiscard]] double drift_mgal(double elapsed_h);
    [[nodiscard]] double links_rate_mgal_per_h();
    [[nodiscard]] double ripple_mgal();
    [[nodiscard]] double outer_oven_mgal();
    [[nodiscard]] double turn_mgal(double face);

    const scenario::Scenario& scenario_;
    const std::vector<scenario::PlannedSetUp>& plan_;
    CoolBox cool_box_;
    DegC ambient_;
    plant::Ovens ovens_;
    plant::TemperatureError error_;
    noise::FlickerNoise flicker_, scale_flicker_;
    noise::ResonantNoise resonant_;
    noise::RandomStream white_, walk_, wander_, temperature_, turns_;
    std::int64_t step_ = 0;
    std::size_t set_up_ = 0;
    double walk_mgal_ = 0.0;
    double face_;                      ///< Face at the last step.
    double turn_mgal_ = 0.0;           ///< Error left by all turns so far.
    std::array<plant::Lag, 3> links_;  ///< One behind the other, the first behind the body.
    double body_degc_;                 ///< Body at the last step.
    double wall_degc_ = 0.0;           ///< Wall of the outer oven at the last step.
    std::optional<plant::Lag> wall_;   ///< Behind this wall.
    double links_mgal_ = 0.0;          ///< Drift by the temperature behind the links.
    double wander_value_ = 0.0;
    double ripple_phase_rad_ = 0.0;
};

}  // namespace a351::sim::signal
