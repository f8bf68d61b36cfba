#include "sim/signal/sensor_clock.hpp"

#include <algorithm>
#include <cmath>

#include "sim/signal/slow_signal.hpp"

namespace a351::sim::signal {

SensorClock::SensorClock(const scenario::ClockParameters& parameters, DegC reference, UtcTime start,
                         std::uint64_t seed)
    : p_(parameters),
      reference_degc_(reference.value()),
      start_(start),
      walk_(seed, "sensor clock") {}

void SensorClock::begin_second(DegC temperature) {
    ++second_;
    late_s_ += longer_s_;
    const double fast =
        1e-6 * (p_.error_ppm + walk_ppm_ +
                p_.temperature_ppm_per_degc * (temperature.value() - reference_degc_));
    longer_s_ = -fast / (1.0 + fast);
    if (p_.wander_ppm_per_sqrt_h > 0.0)
        walk_ppm_ += p_.wander_ppm_per_sqrt_h / std::sqrt(kSecondsPerHour) * walk_.normal();
}

UtcTime SensorClock::at(double share) const {
    return start_ + std::chrono::seconds(second_) + from_seconds(share) +
           from_seconds(late_s_ + share * longer_s_);
}

std::vector<scenario::PlannedSetUp> by_true_time(const scenario::Scenario& scenario,
                                                 const std::vector<scenario::PlannedSetUp>& plan,
                                                 std::uint64_t seed) {
    std::vector<scenario::PlannedSetUp> turned = plan;
    const scenario::ClockParameters& p = scenario.clock;
    const bool is_true =
        p.error_ppm == 0.0 && p.wander_ppm_per_sqrt_h == 0.0 && p.temperature_ppm_per_degc == 0.0;
    if (is_true) return turned;
    std::vector<UtcTime*> limits;
    for (scenario::PlannedSetUp& set_up : turned) {
        limits.insert(limits.end(), {&set_up.from, &set_up.start, &set_up.end});
    }
    std::ranges::stable_sort(limits, {}, [](const UtcTime* limit) { return *limit; });

    SlowSignal slow(scenario, plan, seed);
    SensorClock clock(p, DegC(scenario.error.reference_degc), scenario.start(), seed);
    clock.begin_second(slow.next().temperature);
    double second = 0.0;
    for (UtcTime* limit : limits) {
        const double counted_s = seconds_between(scenario.start(), *limit);
        for (; second + 1.0 <= counted_s; second += 1.0)
            clock.begin_second(slow.next().temperature);
        *limit = clock.at(counted_s - second);
    }
    return turned;
}

}  // namespace a351::sim::signal
