#include "tests/support/two_path_truth.hpp"

#include <cmath>

#include "sim/scenario/survey_plan.hpp"

using namespace a351::sim::plant;
using namespace a351::sim::scenario;

namespace a351::sim {

using corrector::long_record::TwoPathTerm;

namespace {
constexpr double kSecondsPerHour = 3600.0;
}

double TwoPathTruth::static_slope() const {
    return (*this)[TwoPathTerm::level] + (*this)[TwoPathTerm::slow];
}

TwoPathTruth two_path_truth(const Scenario& scenario, std::uint64_t seed) {
    const TemperatureErrorParameters unit = drawn_unit(scenario, seed);
    const SensorParameters& sensor = scenario.sensor;
    const double fast = -unit.crystal_dynamic_mgal_per_degc * unit.crystal_tau_s / kSecondsPerHour;

    // The first-order lag of exp(-t / shown_s) is exp(-t / shown_s) times 1 / (1 - lag / shown_s).
    const double shown_s = kSecondsPerHour * sensor.temperature_warm_up_tau_h;
    const auto follows = [shown_s](double lag_s) { return 1.0 / (1.0 - lag_s / shown_s); };
    const double since_h = sensor.power_on_before_start_h;
    const double shown =
        sensor.temperature_warm_up_degc * std::exp(-since_h / sensor.temperature_warm_up_tau_h) *
        (unit.crystal_static_mgal_per_degc +
         fast * kSecondsPerHour * (1.0 - follows(unit.crystal_tau_s)) / unit.crystal_tau_s +
         unit.clock_mgal_per_degc * follows(unit.clock_tau_s));
    const double hidden = unit.warm_up_mgal * std::exp(-since_h / unit.warm_up_tau_h);
    const double slope_per_h =
        hidden / unit.warm_up_tau_h - shown / sensor.temperature_warm_up_tau_h;

    TwoPathTruth truth;
    const auto set = [&truth](TwoPathTerm term, double value) {
        truth.values.at(static_cast<std::size_t>(term)) = value;
    };
    set(TwoPathTerm::drift, scenario.slow_noise.drift_linear_mgal_per_h);
    set(TwoPathTerm::warm_up, hidden - shown);
    set(TwoPathTerm::level, unit.crystal_static_mgal_per_degc);
    set(TwoPathTerm::fast, fast);
    set(TwoPathTerm::slow, unit.clock_mgal_per_degc);
    set(TwoPathTerm::fast_lag, unit.crystal_tau_s);
    set(TwoPathTerm::slow_lag, unit.clock_tau_s);
    set(TwoPathTerm::warm_up_time, kSecondsPerHour * (hidden - shown) / slope_per_h);
    return truth;
}

double deviation(const corrector::long_record::TwoPathFit& fit, const TwoPathTruth& truth,
                 TwoPathTerm term) {
    const corrector::long_record::FittedParameter& parameter = fit[term];
    const bool is_lag = term >= TwoPathTerm::fast_lag;
    const double off = is_lag ? parameter.value * std::log(parameter.value / truth[term])
                              : parameter.value - truth[term];
    return off / parameter.standard_error;
}

double static_slope_deviation(const corrector::long_record::TwoPathFit& fit,
                              const TwoPathTruth& truth) {
    return (fit.static_slope - truth.static_slope()) / fit.static_slope_error;
}

}  // namespace a351::sim
