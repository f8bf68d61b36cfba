#include "sim/signal/slow_signal.hpp"

#include <cmath>
#include <numbers>

#include "sim/signal/earth_tide.hpp"

namespace a351::sim {
namespace {

/// Time over which the period of the ripple wanders: some ten of its periods.
constexpr double kWanderSeconds = 600.0;

/// White noise is given as the rms of 20 s means, the sampling of the published record.
constexpr double kWhiteMeanSeconds = 20.0;

/// The oven has been running for hours when the record starts: its cycle is established after two.
constexpr int kRunInSteps = 7200;

ThermalPlant running_plant(const Scenario& scenario) {
    const DegC ambient = scenario.ambient(scenario.start());
    ThermalPlant plant(scenario.oven, ambient);
    for (int i = 0; i < kRunInSteps; ++i) plant.step(ambient);
    return plant;
}

}  // namespace

SlowSignal::SlowSignal(const Scenario& scenario, const std::vector<PlannedOccupation>& plan,
                       std::uint64_t seed)
    : scenario_(scenario),
      plan_(plan),
      plant_(running_plant(scenario)),
      error_(scenario.error, plant_.body(), kStepSeconds),
      flicker_(RandomStream(seed, "flicker"), scenario.slow_noise.flicker_mgal,
               scenario.slow_noise.flicker_shortest_s, scenario.slow_noise.flicker_longest_s,
               kStepSeconds),
      resonant_(RandomStream(seed, "resonant"), scenario.slow_noise.resonant_mgal,
                scenario.slow_noise.resonant_period_s, scenario.slow_noise.resonant_quality,
                kStepSeconds),
      white_(seed, "slow white"),
      walk_(seed, "random walk"),
      wander_(seed, "ripple wander") {
    RandomStream placement(seed, "placement");
    for (std::size_t i = 0; i < plan_.size(); ++i) {
        placement_mgal_.push_back(scenario.slow_noise.placement_mgal * placement.normal());
    }
}

double SlowSignal::drift_mgal(double elapsed_h) {
    const SlowNoiseParameters& p = scenario_.slow_noise;
    walk_mgal_ += p.drift_walk_mgal_per_sqrt_h * std::sqrt(kStepSeconds / 3600.0) * walk_.normal();
    return elapsed_h * (p.drift_linear_mgal_per_h + elapsed_h * p.drift_quadratic_mgal_per_h2) +
           walk_mgal_;
}

double SlowSignal::ripple_mgal() {
    const SlowNoiseParameters& p = scenario_.slow_noise;
    const double keep = std::exp(-kStepSeconds / kWanderSeconds);
    wander_value_ = keep * wander_value_ + std::sqrt(1.0 - keep * keep) * wander_.normal();
    ripple_phase_rad_ += 2.0 * std::numbers::pi * kStepSeconds /
                         (p.ripple_period_s * std::exp(p.ripple_wander * wander_value_));
    return p.ripple_mgal * std::sin(ripple_phase_rad_);
}

SlowValue SlowSignal::next() {
    const double elapsed_s = static_cast<double>(step_) * kStepSeconds;
    const UtcTime now = scenario_.start() + from_seconds(elapsed_s);
    while (occupation_ + 1 < plan_.size() && plan_[occupation_ + 1].arrival <= now) ++occupation_;
    const text::Site& site = plan_[occupation_].site;
    const double since_power_on_s = elapsed_s + 3600.0 * scenario_.sensor.power_on_before_start_h;
    if (step_ > 0) plant_.step(scenario_.ambient(now));
    ++step_;

    SlowValue value;
    value.occupation = occupation_;
    value.vertical = *site.gravity + earth_tide(site.latitude, site.longitude, site.altitude, now) +
                     MilliGal(scenario_.sensor.bias_mgal) +
                     error_.next(plant_.body(), since_power_on_s) +
                     MilliGal(placement_mgal_[occupation_] + flicker_.next() + resonant_.next() +
                              scenario_.slow_noise.white_mgal *
                                  std::sqrt(kWhiteMeanSeconds / kStepSeconds) * white_.normal() +
                              drift_mgal(elapsed_s / 3600.0) + ripple_mgal());
    value.temperature =
        plant_.body() +
        DegC(scenario_.sensor.temperature_warm_up_degc *
             std::exp(-since_power_on_s / (3600.0 * scenario_.sensor.temperature_warm_up_tau_h)));
    return value;
}

}  // namespace a351::sim
