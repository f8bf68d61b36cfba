#include "sim/plant/thermal_plant.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <vector>
#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"
#include "sim/plant/ovens.hpp"
#include "sim/plant/temperature_error.hpp"
#include "sim/signal/signal_source.hpp"
#include "tests/unit/sim/made_up_scenario.hpp"

using namespace a351::sim;
using namespace a351;
using namespace a351::sim::plant;
using namespace a351::sim::scenario;
using namespace a351::sim::signal;

namespace {

/// Returns the body temperature once a second at constant ambient, in the settled limit cycle.
std::vector<double> limit_cycle_degc(double ambient_degc,
                                     ControllerKind kind = ControllerKind::pi) {
    OvenParameters oven = load_scenario("tsukuba").oven;
    oven.controller = kind;
    ThermalPlant plant(oven, DegC(ambient_degc));
    for (int i = 0; i < 8 * 3600; ++i) plant.step(DegC(ambient_degc));
    std::vector<double> body_degc;
    for (int i = 0; i < 8 * 3600; ++i) {
        plant.step(DegC(ambient_degc));
        body_degc.push_back(plant.body().value());
    }
    return body_degc;
}

double mean(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

struct Cycle {
    double period_s, swing_degc;
};

/// Returns the cycle of a series with one value per second: mean time between rises through the
/// mean, and peak-to-peak swing of the sine with the same variance.
Cycle cycle_of(const std::vector<double>& values) {
    const double middle = mean(values);
    double square = 0.0;
    int rising = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        square += (values[i] - middle) * (values[i] - middle);
        if (i > 0 && values[i - 1] < middle && values[i] >= middle) ++rising;
    }
    const double seconds = static_cast<double>(values.size());
    return {seconds / rising, 2.0 * std::sqrt(2.0 * square / seconds)};
}

/// Returns the complex gain of the temperature error at a period, in mGal per degC.
std::complex<double> response(double period_s) {
    const TemperatureErrorParameters parameters = load_scenario("tsukuba").error;
    constexpr double kStep = 1.0;
    TemperatureError error(parameters, DegC(parameters.reference_degc), kStep);
    const double w = 2.0 * std::numbers::pi / period_s;
    std::complex<double> out = 0.0, in = 0.0;
    const int settle = static_cast<int>(20.0 * parameters.clock_tau_s / period_s + 2.0);
    for (int i = 0; i < static_cast<int>((settle + 4) * period_s); ++i) {
        const double t = i * kStep;
        const double wave_degc = 0.01 * std::sin(w * t);
        // Long after power-on the warm-up term is gone.
        const double mgal = error.next(DegC(parameters.reference_degc + wave_degc), 1e9).value();
        if (t < settle * period_s) continue;
        out += mgal * std::polar(1.0, -w * t);
        in += wave_degc * std::polar(1.0, -w * t);
    }
    return out / in;
}

const ThermalPlant& outer_of(Ovens& ovens) {
    const ThermalPlant* const outer = ovens.outer();
    if (outer == nullptr) throw std::logic_error("no outer oven");
    return *outer;
}

}  // namespace

TEST_CASE("heat flows balance in equilibrium if the controller has a fine resolution") {
    OvenParameters oven = load_scenario("tsukuba").oven;
    oven.resolution_degc = 1e-6;
    ThermalPlant plant(oven, DegC(26.0));
    const double body_degc = plant.body().value();
    for (int i = 0; i < 3600; ++i) plant.step(DegC(26.0));
    CHECK(plant.body().value() == Approx(body_degc).margin(1e-5));
    CHECK(plant.heater().value() == Approx(oven.set_point_degc).margin(1e-5));
}

TEST_CASE("the body follows ambient by the ratio of the resistances") {
    // Rhb / (Rhb + Rba) = 5 / 83 = 0.060 degC per degC.
    const double rise_degc = mean(limit_cycle_degc(34.0)) - mean(limit_cycle_degc(24.0));
    CHECK(rise_degc / 10.0 == Approx(5.0 / 83.0).margin(0.002));
}

TEST_CASE("a coarse resolution makes a limit cycle of 700 to 1050 s and 0.010 to 0.025 degC") {
    // Published (Matsuda et al.): 10-15 min and about 0.02 degC peak to peak.
    for (const double ambient_degc : {24.0, 29.0, 34.0}) {
        const Cycle cycle = cycle_of(limit_cycle_degc(ambient_degc));
        CAPTURE(ambient_degc);
        CHECK(cycle.period_s > 700.0);
        CHECK(cycle.period_s < 1050.0);
        CHECK(cycle.swing_degc > 0.010);
        CHECK(cycle.swing_degc < 0.025);
    }
}

TEST_CASE("without an outer oven the pair is the single plant") {
    OvenParameters oven = load_scenario("tsukuba").oven;
    oven.run_in_h = 0.0;
    ThermalPlant plant(oven, DegC(26.0));
    Ovens ovens(oven, std::nullopt, DegC(26.0));
    CHECK(ovens.outer() == nullptr);
    for (int i = 0; i < 3600; ++i) {
        plant.step(DegC(26.0));
        ovens.step(DegC(26.0));
        REQUIRE(ovens.inner().body() == plant.body());
    }
}

TEST_CASE("an outer oven has its own cycle, shields the inner one, and is warmed by it") {
    const Scenario scenario = load_scenario("double-oven");
    const OvenParameters outer = scenario.outer_oven->oven;
    std::vector<double> bodies_degc;
    for (const double ambient_degc : {24.0, 34.0}) {
        Ovens ovens(scenario.oven, outer, DegC(ambient_degc));
        std::vector<double> wall_degc, body_degc;
        for (int i = 0; i < 8 * 3600; ++i) {
            ovens.step(DegC(ambient_degc));
            wall_degc.push_back(outer_of(ovens).heater().value());
            body_degc.push_back(ovens.inner().body().value());
        }
        CAPTURE(ambient_degc);
        CHECK(mean(wall_degc) == Approx(outer.set_point_degc).margin(0.4));
        const Cycle cycle = cycle_of(wall_degc);
        CHECK(cycle.period_s > 500.0);
        CHECK(cycle.period_s < 1500.0);
        CHECK(cycle.swing_degc > 0.5);
        CHECK(cycle.swing_degc < 1.5);
        bodies_degc.push_back(mean(body_degc));
    }
    // A single oven's body rises by 5/83 of the ambient's 10 degC; behind the outer one by a tenth.
    CHECK(bodies_degc[1] - bodies_degc[0] > 0.0);
    CHECK(bodies_degc[1] - bodies_degc[0] < 0.1 * 10.0 * 5.0 / 83.0);

    // The heat of the inner oven, 0.46 W, warms what is around it.
    ThermalPlant alone(outer, DegC(24.0));
    Ovens ovens(scenario.oven, outer, DegC(24.0));
    std::vector<double> empty_degc, full_degc;
    for (int i = 0; i < 8 * 3600; ++i) {
        alone.step(DegC(24.0));
        ovens.step(DegC(24.0));
        empty_degc.push_back(alone.body().value());
        full_degc.push_back(outer_of(ovens).body().value());
    }
    CHECK(mean(full_degc) - mean(empty_degc) > 0.2);
}

TEST_CASE("an on/off controller cycles faster and with a larger swing") {
    // Not published: periods and swings are from a script that integrates the same equations
    // independently of this code.  Half the dead time would give 240-360 s and 0.055 degC.
    struct Row {
        double ambient_degc, period_s, swing_degc;
    };
    for (const Row row :
         {Row{24.0, 343.0, 0.111}, Row{29.0, 395.0, 0.111}, Row{34.0, 514.0, 0.117}}) {
        const Cycle cycle = cycle_of(limit_cycle_degc(row.ambient_degc, ControllerKind::on_off));
        CAPTURE(row.ambient_degc);
        CHECK(cycle.period_s == Approx(row.period_s).epsilon(0.005));
        CHECK(cycle.swing_degc == Approx(row.swing_degc).margin(0.0005));
    }
}

TEST_CASE("the scenario selects the kind of controller") {
    const auto kind_of = [](const std::string& line) {
        return changed("tsukuba", "[oven]\n" + line).oven.controller;
    };
    CHECK(kind_of("") == ControllerKind::pi);
    CHECK(kind_of("controller = \"onoff\"\n") == ControllerKind::on_off);
    CHECK_THROWS_AS(kind_of("controller = \"fuzzy\"\n"), InputError);
}

TEST_CASE("the oven follows its set point") {
    ThermalPlant plant(load_scenario("tsukuba").oven, DegC(26.0));
    plant.set_set_point(DegC(44.0));
    for (int i = 0; i < 3 * 3600; ++i) plant.step(DegC(26.0));
    CHECK(plant.controller_reading().value() == Approx(44.0).margin(0.11));
}

TEST_CASE("an oven that is stopped or without its sensor cools, and recovers afterwards") {
    const bool is_stop = GENERATE(true, false);
    CAPTURE(is_stop);
    ThermalPlant plant(load_scenario("tsukuba").oven, DegC(26.0));
    const auto disturb = [&plant, is_stop](bool is_on) {
        is_stop ? plant.set_running(!is_on) : plant.break_sensor(is_on);
    };
    disturb(true);
    for (int i = 0; i < 6 * 3600; ++i) {
        plant.step(DegC(26.0));
        REQUIRE(plant.drive() == 0.0);
    }
    CHECK(plant.body().value() < 30.0);
    CHECK(plant.controller_reading().value() < 30.0);
    disturb(false);
    for (int i = 0; i < 6 * 3600; ++i) plant.step(DegC(26.0));
    CHECK(plant.controller_reading().value() == Approx(42.5).margin(0.11));
}

TEST_CASE("proportional band and integral time give the gains of the scenario") {
    ThermalPlant plant(load_scenario("tsukuba").oven, DegC(26.0));
    CHECK(plant.tuning().proportional_band_degc == Approx(5.0));
    CHECK(plant.tuning().integral_time_s == Approx(0.2 / 0.0015));
    ThermalPlant same = plant;
    same.set_tuning(plant.tuning());
    for (int i = 0; i < 3600; ++i) {
        plant.step(DegC(26.0));
        same.step(DegC(26.0));
        REQUIRE(same.body().value() == Approx(plant.body().value()).margin(1e-9));
    }
}

TEST_CASE("writing a set point changes the samples from then on, and reading it changes none") {
    const Scenario scenario = load_scenario("tsukuba");
    const wire::DeviceProfile& profile = *wire::find_profile("A351");
    signal::Source untouched(scenario, profile, 1), looked_at(scenario, profile, 1),
        written(scenario, profile, 1);
    constexpr int kWriteAt = 60 * signal::Source::kRateHz;
    bool has_changed = false;
    for (int i = 0; i < 5 * kWriteAt; ++i) {
        if (i == kWriteAt) written.oven().set_set_point(DegC(50.0));
        REQUIRE(looked_at.oven().set_point() == DegC(42.5));
        const SensorSample expected = untouched.next().values;
        REQUIRE(looked_at.next().values == expected);
        const bool is_same = written.next().values == expected;
        if (i < kWriteAt) REQUIRE(is_same);
        has_changed |= !is_same;
    }
    CHECK(has_changed);
}

TEST_CASE("the temperature error has the gain and phase of its transfer function") {
    // H(s) = rA - kA s tauA / (1 + s tauA) + rC / (1 + s tauC), computed without this code.
    struct Row {
        double period_s, gain, phase_deg;
    };
    for (const Row row : {Row{300.0, 628.0, 49.0}, Row{600.0, 386.0, 67.0}, Row{900.0, 271.0, 76.0},
                          Row{1800.0, 142.0, 87.0}, Row{3600.0, 75.0, 96.0},
                          Row{14400.0, 34.0, 126.0}, Row{36000.0, 32.0, 152.0}}) {
        const std::complex<double> h = response(row.period_s);
        CAPTURE(row.period_s);
        CHECK(std::abs(h) == Approx(row.gain).epsilon(0.015));  // Rounded; step of 1 s in 43 s.
        CHECK(std::arg(h) * 180.0 / std::numbers::pi == Approx(row.phase_deg).margin(1.5));
    }
}

TEST_CASE("a constant temperature difference gives the static slope, and the warm-up error decays") {
    const TemperatureErrorParameters parameters = load_scenario("tsukuba").error;
    TemperatureError cold(parameters, DegC(42.5), 1.0);
    TemperatureError warm(parameters, DegC(43.5), 1.0);
    const MilliGal difference = warm.next(DegC(43.5), 1e9) - cold.next(DegC(42.5), 1e9);
    CHECK(difference.value() == Approx(-32.0));
    CHECK(cold.next(DegC(42.5), 0.0).value() == Approx(36.0));
    CHECK(cold.next(DegC(42.5), 2.5 * 3600.0).value() == Approx(36.0 / std::numbers::e));
}
