#include "sim/signal/slow_signal.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "sim/signal/earth_tide.hpp"

namespace a351::sim::signal {
namespace {

/// Interval of the means whose rms is the given white noise, s: the sampling of the published
/// record.
constexpr double kWhiteMeanSeconds = 20.0;

std::optional<plant::OvenParameters> outer_oven_of(const scenario::Scenario& scenario) {
    return scenario.outer_oven ? std::optional(scenario.outer_oven->oven) : std::nullopt;
}

std::array<plant::Lag, 3> equal_links(double tau_s, DegC body) {
    const plant::Lag link(tau_s, SlowSignal::kStepSeconds, body.value());
    return {link, link, link};
}

}  // namespace

SlowSignal::SlowSignal(const scenario::Scenario& scenario,
                       const std::vector<scenario::PlannedSetUp>& plan, std::uint64_t seed)
    : scenario_(scenario),
      plan_(plan),
      cool_box_(scenario, plan, seed),
      ambient_(cool_box_.next()),
      ovens_(scenario.oven, outer_oven_of(scenario), ambient_),
      error_(scenario::drawn_unit(scenario, seed), ovens_.inner().body(), kStepSeconds),
      flicker_(noise::RandomStream(seed, "flicker"), scenario.slow_noise.flicker_mgal,
               scenario.slow_noise.flicker_shortest_s, scenario.slow_noise.flicker_longest_s,
               kStepSeconds),
      scale_flicker_(noise::RandomStream(seed, "flicker of the scale"),
                     scenario.slow_noise.flicker_mgal, scenario.slow_noise.flicker_shortest_s,
                     scenario.slow_noise.flicker_longest_s, kStepSeconds),
      resonant_(noise::RandomStream(seed, "resonant"), scenario.slow_noise.resonant_mgal,
                scenario.slow_noise.resonant_period_s, scenario.slow_noise.resonant_quality,
                kStepSeconds),
      white_(seed, "slow white"),
      walk_(seed, "random walk"),
      wander_(seed, "ripple wander"),
      temperature_(seed, "slow temperature"),
      turns_(seed, "turns"),
      face_(plan.front().face),
      links_(equal_links(scenario.slow_noise.drift_link_tau_s, ovens_.inner().body())),
      body_degc_(ovens_.inner().body().value()) {
    if (const plant::ThermalPlant* outer = ovens_.outer()) {
        wall_degc_ = outer->heater().value();
        wall_.emplace(scenario.outer_oven->reading_tau_s, kStepSeconds, wall_degc_);
    }
}

double SlowSignal::outer_oven_mgal() {
    const plant::ThermalPlant* const outer = ovens_.outer();
    if (!wall_ || outer == nullptr) return 0.0;
    const double from_degc = std::exchange(wall_degc_, outer->heater().value());
    const scenario::OuterOvenParameters& p = *scenario_.outer_oven;
    return p.reading_mgal_per_degc * (wall_->next(from_degc, wall_degc_) - p.oven.set_point_degc);
}

double SlowSignal::links_rate_mgal_per_h() {
    double before_degc = body_degc_, degc = body_degc_ = ovens_.inner().body().value();
    for (plant::Lag& link : links_) {
        const double from_degc = std::exchange(before_degc, link.degc());
        degc = link.next(from_degc, degc);
    }
    return scenario_.slow_noise.drift_links_mgal_per_h_per_degc *
           (degc - scenario_.error.reference_degc);
}

double SlowSignal::drift_mgal(double elapsed_h) {
    const scenario::SlowNoiseParameters& p = scenario_.slow_noise;
    walk_mgal_ += p.drift_walk_mgal_per_sqrt_h * std::sqrt(kStepSeconds / 3600.0) * walk_.normal();
    links_mgal_ += links_rate_mgal_per_h() * kStepSeconds / 3600.0;
    return elapsed_h * (p.drift_linear_mgal_per_h + elapsed_h * p.drift_quadratic_mgal_per_h2) +
           walk_mgal_ + links_mgal_;
}

double SlowSignal::ripple_mgal() {
    const scenario::SlowNoiseParameters& p = scenario_.slow_noise;
    const double keep = std::exp(-kStepSeconds / p.ripple_wander_s);
    wander_value_ = keep * wander_value_ + std::sqrt(1.0 - keep * keep) * wander_.normal();
    ripple_phase_rad_ += 2.0 * std::numbers::pi * kStepSeconds /
                         (p.ripple_period_s * std::exp(p.ripple_wander * wander_value_));
    return p.ripple_mgal * std::sin(ripple_phase_rad_);
}

double SlowSignal::turn_mgal(double face) {
    const scenario::SensorParameters& p = scenario_.sensor;
    turn_mgal_ *= std::exp(-kStepSeconds / p.turn_tau_s);
    if (std::exchange(face_, face) != face) turn_mgal_ += p.turn_mgal * turns_.normal();
    return turn_mgal_;
}

SlowValue SlowSignal::next() {
    const double elapsed_s = static_cast<double>(step_) * kStepSeconds;
    const UtcTime now = scenario_.start() + from_seconds(elapsed_s);
    while (set_up_ + 1 < plan_.size() && plan_[set_up_ + 1].from <= now) ++set_up_;
    const scenario::PlannedSetUp& set_up = plan_[set_up_];
    const double since_power_on_s = elapsed_s + 3600.0 * scenario_.sensor.power_on_before_start_h;
    if (step_ > 0) {
        ambient_ = cool_box_.next();
        ovens_.step(ambient_);
    }
    ++step_;

    SlowValue value;
    value.set_up = set_up_;
    value.ambient = ambient_;
    const auto term = [&value](Term t) -> double& {
        return value.terms_mgal[static_cast<std::size_t>(t)];
    };
    const text::Site& site = set_up.site;
    const MilliGal tide = earth_tide(site.latitude, site.longitude, site.altitude, now,
                                     scenario_.tide.gravimetric_factor);
    const MilliGal temperature_error = error_.next(ovens_.inner().body(), since_power_on_s);
    const double white_gain = std::sqrt(kWhiteMeanSeconds / kStepSeconds);
    term(Term::tide) = tide.value();
    term(Term::bias) = scenario_.sensor.bias_mgal;
    term(Term::crystal_static) = error_.terms().static_mgal;
    term(Term::crystal_dynamic) = error_.terms().dynamic_mgal;
    term(Term::clock) = error_.terms().clock_mgal;
    term(Term::warm_up) = error_.terms().warm_up_mgal;
    term(Term::placement) = set_up.placement_mgal;
    term(Term::resonant) = resonant_.next();
    term(Term::white) = scenario_.slow_noise.white_mgal * white_gain * white_.normal();
    term(Term::drift) = drift_mgal(elapsed_s / 3600.0) + set_up.step_mgal;
    term(Term::ripple) = ripple_mgal();
    term(Term::outer_oven) = outer_oven_mgal();
    term(Term::scale) = (scenario_.sensor.scale - 1.0) *
                        (site.gravity->value() + tide.value() - kMilliGalPerStandardGravity);
    term(Term::turn) = turn_mgal(set_up.face);
    const double share = scenario_.sensor.scale_share;
    const MilliGal errors = temperature_error + MilliGal(term(Term::resonant) + term(Term::drift) +
                                                         term(Term::outer_oven) + term(Term::turn));
    // Bias and scale flicker by themselves; in one face their sum has the size of the scenario.
    const double size = std::hypot(1.0 - share, share);
    const double of_bias = (1.0 - share) / size * flicker_.next();
    const double of_scale = share / size * scale_flicker_.next();
    value.along_z =
        MilliGal(scenario_.sensor.bias_mgal + term(Term::placement) + of_bias + term(Term::white)) +
        (1.0 - share) * errors;
    value.along_vertical = *site.gravity + tide +
                           MilliGal(term(Term::ripple) + term(Term::scale) + of_scale) +
                           share * errors;
    term(Term::flicker) = set_up.face * of_bias + of_scale;
    for (const Term bias : {Term::bias, Term::placement, Term::white}) term(bias) *= set_up.face;
    const double sign = share + (1.0 - share) * set_up.face;
    for (const Term error :
         {Term::crystal_static, Term::crystal_dynamic, Term::clock, Term::warm_up, Term::resonant,
          Term::drift, Term::outer_oven, Term::turn})
        term(error) *= sign;
    value.temperature =
        ovens_.inner().body() +
        DegC(scenario_.sensor.temperature_warm_up_degc *
             std::exp(-since_power_on_s / (3600.0 * scenario_.sensor.temperature_warm_up_tau_h)));
    if (scenario_.slow_noise.temperature_degc > 0.0) {
        value.temperature = value.temperature + DegC(scenario_.slow_noise.temperature_degc *
                                                     white_gain * temperature_.normal());
    }
    return value;
}

}  // namespace a351::sim::signal
