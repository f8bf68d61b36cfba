#include "sim/signal/sensor_clock.hpp"

#include <cmath>

namespace a351::sim {

SensorClock::SensorClock(const ClockParameters& parameters, DegC reference, UtcTime start,
                         std::uint64_t seed)
    : p_(parameters),
      reference_degc_(reference.value()),
      start_(start),
      walk_(seed, "sensor clock") {}

void SensorClock::begin_second(DegC temperature) {
    constexpr double kSecondsPerHour = 3600.0;
    ++second_;
    late_s_ += longer_s_;
    const double fast =
        1e-6 * (p_.error_ppm + walk_ppm_ +
                p_.temperature_ppm_per_degc * (temperature.value() - reference_degc_));
    longer_s_ = -fast / (1.0 + fast);
    if (p_.wander_ppm_per_sqrt_h > 0.0) {
        walk_ppm_ += p_.wander_ppm_per_sqrt_h / std::sqrt(kSecondsPerHour) * walk_.normal();
    }
}

UtcTime SensorClock::at(double share) const {
    return start_ + std::chrono::seconds(second_) + from_seconds(share) +
           from_seconds(late_s_ + share * longer_s_);
}

}  // namespace a351::sim
