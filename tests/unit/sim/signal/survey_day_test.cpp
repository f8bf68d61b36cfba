/// Compares the simulated survey day and the simulated night indoors with the published ones.  The
/// long form with more seeds and with EEMD is plant_statistics_bench.

#include <cmath>
#include <numbers>
#include <vector>
#include "tests/support/catch.hpp"

#include "corrector/reading/band_pass.hpp"
#include "protocol/text/csv.hpp"
#include "tests/support/plant_statistics.hpp"

using namespace a351;
using namespace a351::sim;
using namespace a351::sim::scenario;

namespace {

void check(const std::vector<Figure>& figures) {
    for (const Figure& figure : figures) {
        CAPTURE(figure.name, figure.published, figure.mean(), figure.deviation());
        CHECK(figure.mean() >= figure.low);
        CHECK(figure.mean() <= figure.high);
    }
}

/// Returns the gain of the band pass for a sine of that period, away from the ends.
double gain(double period_s) {
    std::vector<double> sine(4000);
    for (std::size_t i = 0; i < sine.size(); ++i) {
        sine[i] = std::sin(2.0 * std::numbers::pi * 20.0 * static_cast<double>(i) / period_s);
    }
    const auto passed = corrector::reading::band_pass(sine, 20.0, 600.0, 1500.0);
    double in = 0.0, out = 0.0;
    for (std::size_t i = 1000; i < 3000; ++i) {
        in += sine[i] * sine[i];
        out += sine[i] * passed[i];  // In phase, because the filter shifts no phase.
    }
    return out / in;
}

}  // namespace

TEST_CASE("the simulated day has the published temperatures") {
    const Scenario scenario = load_scenario("tsukuba");
    const text::CsvTable rows = text::read_csv(A351_GOLDEN "/tsukuba/observations.csv");
    constexpr int kSeeds = 10;
    std::vector<double> mean_degc(rows.row_count());
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const auto simulated = survey_day(scenario, seed);
        for (std::size_t i = 0; i < mean_degc.size(); ++i) {
            mean_degc[i] += simulated[i].temperature_degc / kSeeds;
        }
    }
    for (std::size_t i = 0; i < mean_degc.size(); ++i) {
        CAPTURE(i);
        CHECK(std::abs(mean_degc[i] - rows.number(i, "temperature_degc")) < 0.04);
    }
}

TEST_CASE("the simulated day has the published day's regression line, scatter and misfits") {
    check(survey_day_figures(20));
}

TEST_CASE("the simulated night has the published night's cycle, slopes and delays") {
    check(indoor_figures(10));
}

TEST_CASE(
    "the band pass of the statistics has gain 1 inside and 1/2 at its corners, and shifts no phase") {
    CHECK(gain(600.0) == Approx(0.5).margin(0.005));
    CHECK(gain(1500.0) == Approx(0.5).margin(0.005));
    CHECK(gain(std::sqrt(600.0 * 1500.0)) == Approx(1.0).margin(0.005));
    CHECK(std::abs(gain(8000.0)) < 0.005);
    CHECK(std::abs(gain(150.0)) < 0.005);
}
