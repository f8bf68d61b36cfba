/// Gain and phase by period against the plant's transfer function.
#include <complex>
#include <numbers>
#include <random>

#include "corrector/long_record/record_analysis.hpp"
#include "sim/scenario/survey_plan.hpp"
#include "tests/unit/long_record/simulated_record.hpp"

using namespace a351;
using namespace a351::corrector::long_record;

namespace {

/// H(s) = rA - kA s tauA / (1 + s tauA) + rC / (1 + s tauC).
std::complex<double> true_response(const sim::plant::TemperatureErrorParameters& unit,
                                   double period_s) {
    const std::complex<double> s(0.0, 2.0 * std::numbers::pi / period_s);
    return unit.crystal_static_mgal_per_degc -
           unit.crystal_dynamic_mgal_per_degc * s * unit.crystal_tau_s /
               (1.0 + s * unit.crystal_tau_s) +
           unit.clock_mgal_per_degc / (1.0 + s * unit.clock_tau_s);
}

struct Count {
    int claimed = 0, covered = 0;

    void add(const ResponsePoint& point, const sim::plant::TemperatureErrorParameters& unit) {
        if (!point.refusal.empty()) return;
        const std::complex<double> truth = true_response(unit, point.period_s);
        const double phase = std::arg(truth) * 180.0 / std::numbers::pi;
        ++claimed;
        const bool is_covered = std::abs(truth) >= point.gain.low &&
                                std::abs(truth) <= point.gain.high &&
                                phase >= point.phase_deg.low && phase <= point.phase_deg.high;
        UNSCOPED_INFO(point.period_s << " s: " << point.gain.value << " [" << point.gain.low << ", "
                                     << point.gain.high << "] at " << point.phase_deg.value
                                     << ", true " << std::abs(truth) << " at " << phase
                                     << (is_covered ? "" : "  MISSED"));
        covered += is_covered ? 1 : 0;
    }
};

}  // namespace

TEST_CASE("the limits by spectrum and by modes cover the plant's response") {
    Count by_spectrum, by_modes;
    int at_cycle = 0;
    constexpr int kSeeds = 10;
    const sim::scenario::Scenario scenario = of_drawn_units("indoor");
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const sim::plant::TemperatureErrorParameters unit =
            sim::scenario::drawn_unit(scenario, seed);
        RecordAnalysisOptions options;
        options.ensemble_size = 60;
        const RecordAnalysis analysis =
            analyse_record(simulated_segment(scenario, seed), kRecordStep_s, options);
        bool is_at_cycle = false;
        for (const ResponsePoint& point : analysis.by_spectrum) {
            by_spectrum.add(point, unit);
            is_at_cycle |= point.refusal.empty() && std::abs(point.period_s - 900.0) < 100.0;
        }
        for (const ResponsePoint& point : analysis.by_modes) by_modes.add(point, unit);
        at_cycle += is_at_cycle ? 1 : 0;
    }
    CHECK(at_cycle == kSeeds);
    CHECK(by_modes.claimed >= kSeeds);
    // The limits hold with 95 % for gain and for phase.
    CHECK(by_spectrum.covered >= 0.85 * by_spectrum.claimed);
    CHECK(by_modes.covered >= 0.85 * by_modes.claimed);
}

TEST_CASE("the thermometer's noise does not lower the gain") {
    // The acceleration follows exactly, so that the limits are as narrow as the noise allows.  At
    // 900 s the noise has a tenth of the power.
    int held = 0, claimed = 0;
    double sum = 0.0;
    for (unsigned seed = 1; seed <= 40; ++seed) {
        std::mt19937_64 random(seed);
        std::normal_distribution<double> normal;
        std::vector<double> temperature, acceleration;
        double now = 0.0, before = 0.0;
        for (int i = 0; i < 2160; ++i) {  // a wide resonance near 900 s
            const double next = 1.75 * now - 0.85 * before + 0.0003 * normal(random);
            before = now;
            now = next;
            temperature.push_back(42.5 + now + 0.0015 * normal(random));
            acceleration.push_back(250.0 * now);
        }
        for (const ResponsePoint& point : response_by_spectrum(temperature, acceleration, 20.0)) {
            if (!point.refusal.empty()) continue;
            ++claimed;
            sum += point.gain.value / 250.0;
            held += point.gain.low <= 250.0 && 250.0 <= point.gain.high ? 1 : 0;
        }
    }
    CAPTURE(claimed, held, sum / claimed);
    CHECK(claimed >= 40);
    CHECK(held >= 0.92 * claimed);
    CHECK(std::abs(sum / claimed - 1.0) < 0.01);
}

TEST_CASE("noise without a response is refused, and so are periods with too few cycles") {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    std::vector<double> temperature, acceleration;
    for (int i = 0; i < 2160; ++i) {
        const double phase = 2.0 * std::numbers::pi * 20.0 * i / 900.0;
        temperature.push_back(42.5 + 0.01 * std::sin(phase) + 0.001 * normal(random));
        acceleration.push_back(normal(random));
    }
    int claimed = 0, short_ones = 0, silent = 0;
    for (const ResponsePoint& point : response_by_spectrum(temperature, acceleration, 20.0)) {
        claimed += point.refusal.empty() ? 1 : 0;
        short_ones += point.refusal == "fewer than 6 cycles" ? 1 : 0;
        silent += point.refusal.english().starts_with("no excitation") ? 1 : 0;
        CHECK(point.refusal.empty() == point.needed.empty());
    }
    CHECK(claimed == 0);
    CHECK(short_ones >= 2);
    CHECK(silent >= 3);
}

TEST_CASE("an acceleration proportional to the temperature has finite limits, not NaN") {
    const std::vector<double> temperature = simulated_segment("indoor", 1).temperature_degc;
    // The coherence is 1 except for rounding in either direction.
    for (const double factor : {-1.0, 1.1, 3.3, 7.7, 13.7, 1e3, 1.7e5}) {
        std::vector<double> acceleration;
        for (const double value : temperature) acceleration.push_back(factor * value);
        for (const auto& point : response_by_spectrum(temperature, acceleration, kRecordStep_s)) {
            CAPTURE(factor, point.period_s);
            CHECK(point.coherence <= 1.0);
            CHECK(std::isfinite(point.gain.low));
            CHECK(std::isfinite(point.phase_deg.high));
        }
    }
}

TEST_CASE("a response that is not a finite number is refused") {
    std::vector<double> temperature = simulated_segment("indoor", 1).temperature_degc;
    const std::vector<double> acceleration = temperature, still(temperature.size(), 0.0);
    const auto is_refused = [](const ResponsePoint& point) { return !point.refusal.empty(); };
    // The values are so small that their squares vanish and quotients by them overflow.
    for (double& value : temperature) value *= 1e-158;
    for (const auto& x : {temperature, still}) {
        const auto points = response_by_spectrum(x, acceleration, kRecordStep_s);
        CHECK(std::all_of(points.begin(), points.end(), is_refused));
        for (const ResponsePoint& point : points) CHECK(std::isfinite(point.gain.high));
    }
    for (const auto& y : {still}) {
        const auto points = response_by_modes({acceleration}, acceleration, y, kRecordStep_s);
        CHECK(std::all_of(points.begin(), points.end(), is_refused));
        for (const ResponsePoint& point : points) CHECK(std::isfinite(point.gain.high));
    }
}
