#include "sim/plant/thermal_plant.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "sim/plant/temperature_error.hpp"
#include "sim/scenario/scenario.hpp"

using namespace a351;
using namespace a351::sim;

namespace {

/// Body temperature once a second at constant ambient, after the limit cycle has established.
std::vector<double> limit_cycle_degc(double ambient_degc) {
    ThermalPlant plant(load_scenario("tsukuba").oven, DegC(ambient_degc));
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

/// Complex gain of the temperature error at a period, in mGal per degC.
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

}  // namespace

TEST_CASE("heat flows balance in equilibrium, with a controller that sees no steps",
          "[sim][thermal_plant]") {
    OvenParameters oven = load_scenario("tsukuba").oven;
    oven.resolution_degc = 1e-6;
    ThermalPlant plant(oven, DegC(26.0));
    const double body_degc = plant.body().value();
    for (int i = 0; i < 3600; ++i) plant.step(DegC(26.0));
    CHECK(plant.body().value() == Approx(body_degc).margin(1e-5));
    CHECK(plant.heater().value() == Approx(oven.set_point_degc).margin(1e-5));
}

TEST_CASE("the body follows ambient by the ratio of the resistances", "[sim][thermal_plant]") {
    // Rhb / (Rhb + Rba) = 5 / 83 = 0.060 degC per degC.
    const double rise_degc = mean(limit_cycle_degc(34.0)) - mean(limit_cycle_degc(24.0));
    CHECK(rise_degc / 10.0 == Approx(5.0 / 83.0).margin(0.002));
}

TEST_CASE("coarse steps make a limit cycle with the published period and swing",
          "[sim][thermal_plant]") {
    // Matsuda et al.: 10-15 min and about 0.02 degC peak to peak.
    for (const double ambient_degc : {24.0, 29.0, 34.0}) {
        const std::vector<double> body_degc = limit_cycle_degc(ambient_degc);
        const double middle_degc = mean(body_degc);
        double square = 0.0;
        int rising = 0;
        for (std::size_t i = 0; i < body_degc.size(); ++i) {
            square += (body_degc[i] - middle_degc) * (body_degc[i] - middle_degc);
            if (i > 0 && body_degc[i - 1] < middle_degc && body_degc[i] >= middle_degc) ++rising;
        }
        const double seconds = static_cast<double>(body_degc.size());
        CAPTURE(ambient_degc);
        CHECK(seconds / rising > 700.0);
        CHECK(seconds / rising < 1050.0);
        const double swing_degc = 2.0 * std::sqrt(2.0 * square / seconds);
        CHECK(swing_degc > 0.010);
        CHECK(swing_degc < 0.025);
    }
}

TEST_CASE("the temperature error has the gain and phase of its transfer function",
          "[sim][temperature_error]") {
    // H(s) = rA - kA s tauA / (1 + s tauA) + rC / (1 + s tauC), evaluated apart from this code.
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

TEST_CASE("a constant temperature gives the static slope", "[sim][temperature_error]") {
    const TemperatureErrorParameters parameters = load_scenario("tsukuba").error;
    TemperatureError cold(parameters, DegC(42.5), 1.0);
    TemperatureError warm(parameters, DegC(43.5), 1.0);
    const MilliGal difference = warm.next(DegC(43.5), 1e9) - cold.next(DegC(42.5), 1e9);
    CHECK(difference.value() == Approx(-32.0));
}

TEST_CASE("the warm-up decays from power-on", "[sim][temperature_error]") {
    const TemperatureErrorParameters parameters = load_scenario("tsukuba").error;
    TemperatureError error(parameters, DegC(42.5), 1.0);
    CHECK(error.next(DegC(42.5), 0.0).value() == Approx(36.0));
    CHECK(error.next(DegC(42.5), 2.5 * 3600.0).value() == Approx(36.0 / std::numbers::e));
}
