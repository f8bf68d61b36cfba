#pragma once

#include <cstdint>
#include <vector>

#include "protocol/core/units.hpp"
#include "sim/noise/noise.hpp"
#include "sim/plant/temperature_error.hpp"
#include "sim/plant/thermal_plant.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/scenario/survey_plan.hpp"

namespace a351::sim {

/// What changes slowly, at one instant.
struct SlowValue {
    MilliGal vertical;  ///< Specific force along the vertical as read: gravity, tide, all errors.
    DegC temperature;   ///< As the sensor reports it, without its white noise.
    std::size_t occupation = 0;  ///< Index in the plan: the site that is or was next.
};

/// Gravity, tide, temperature error, drift, slow noise and ripple, once a second from the start of
/// the record: the n-th value belongs to start + n s.
class SlowSignal {
public:
    static constexpr double kStepSeconds = ThermalPlant::kStepSeconds;

    SlowSignal(const Scenario& scenario, const std::vector<PlannedOccupation>& plan,
               std::uint64_t seed);

    [[nodiscard]] SlowValue next();

private:
    [[nodiscard]] double drift_mgal(double elapsed_h);
    [[nodiscard]] double ripple_mgal();

    const Scenario& scenario_;
    const std::vector<PlannedOccupation>& plan_;
    ThermalPlant plant_;
    TemperatureError error_;
    FlickerNoise flicker_;
    ResonantNoise resonant_;
    RandomStream white_, walk_, wander_;
    std::vector<double> placement_mgal_;  ///< One per occupation.
    std::int64_t step_ = 0;
    std::size_t occupation_ = 0;
    double walk_mgal_ = 0.0;
    double wander_value_ = 0.0;
    double ripple_phase_rad_ = 0.0;
};

}  // namespace a351::sim
