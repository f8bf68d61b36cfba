#pragma once

#include <cstdint>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "sim/noise/random.hpp"
#include "sim/scenario/survey_plan.hpp"

namespace a351::sim::signal {

/// True time of the sensor's samples.  The sensor's clock runs fast by
///
///     r(t) = error + walk(t) + temperature coefficient x (T - T0)
///
/// r is constant over each second that the clock counts; that second lasts 1 / (1 + r) s.
class SensorClock {
public:
    /// @param reference  T0.
    SensorClock(const scenario::ClockParameters& parameters, DegC reference, UtcTime start,
                std::uint64_t seed);

    /// Begins the first or the next second of the clock, at this temperature.
    void begin_second(DegC temperature);

    /// Returns the true time of a point of the current second.
    /// @param share  position within the second, in [0, 1).
    [[nodiscard]] UtcTime at(double share) const;

private:
    scenario::ClockParameters p_;
    double reference_degc_;
    UtcTime start_;
    noise::RandomStream walk_;
    std::int64_t second_ = -1;
    double walk_ppm_ = 0.0;
    double late_s_ = 0.0;    ///< Start of the second minus its nominal instant.
    double longer_s_ = 0.0;  ///< Length of the second minus 1 s.
};

/// Returns the plan with its limits converted from the sensor's time, in which a scenario is
/// written, to UTC.  With a true clock the plan is unchanged.
[[nodiscard]] std::vector<scenario::PlannedSetUp> by_true_time(
    const scenario::Scenario& scenario, const std::vector<scenario::PlannedSetUp>& plan,
    std::uint64_t seed);

}  // namespace a351::sim::signal
