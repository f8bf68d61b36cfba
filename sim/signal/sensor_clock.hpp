#pragma once

#include <cstdint>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "sim/noise/random.hpp"
#include "sim/scenario/scenario.hpp"

namespace a351::sim {

/// When the sensor takes its samples, by true time.  Its clock runs fast by
///
///     r(t) = error + walk(t) + temperature coefficient x (T - T0)
///
/// constant over each second that it counts, which lasts 1 / (1 + r) s.
class SensorClock {
public:
    /// @param reference  T0.
    SensorClock(const ClockParameters& parameters, DegC reference, UtcTime start,
                std::uint64_t seed);

    /// Begins the second after the one that runs, or the first one, at this temperature.
    void begin_second(DegC temperature);

    /// Of a point of the second that runs, as share of it in [0, 1).
    [[nodiscard]] UtcTime at(double share) const;

private:
    ClockParameters p_;
    double reference_degc_;
    UtcTime start_;
    RandomStream walk_;
    std::int64_t second_ = -1;
    double walk_ppm_ = 0.0;
    double late_s_ = 0.0;    ///< Start of the second, after its nominal instant.
    double longer_s_ = 0.0;  ///< Length of the second beyond 1 s.
};

}  // namespace a351::sim
