#include "corrector/long_record/tilt_record.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "corrector/archive_series/tilt.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/core/units.hpp"
#include "sim/noise/random.hpp"
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector;
using namespace a351::corrector::long_record;

namespace {

constexpr double kSlope = 30.0;      // urad/degC
constexpr double kBias = -12'000.0;  // urad
constexpr double kStep_h = 20.0 / 3600.0;

/// Returns the tilt of the ground: a rate, a step and the temperature's effect are added by samples.
double history_urad(double hours) { return 4.0 * hours + (hours > 9.001 ? 60.0 : 0.0); }

/// Returns a record of a sensor whose x axis is tilted, at a temperature with the cycle of the oven
/// and a part of the day.
LongRecord tilted(double hours, double white, double walk, std::uint64_t seed,
                  double (*history)(double)) {
    sim::noise::RandomStream stream(seed, "tilt");
    RecordStretch stretch;
    stretch.axes_mgal.resize(3);
    double wandering = 0.0;
    const double phase = stream.uniform(0.0, 6.28);
    for (double t = 0.0; t < hours; t += kStep_h) {
        const double degc = 42.5 + 0.01 * std::sin(2.0 * std::numbers::pi * t / 0.25) +
                            0.1 * std::sin(2.0 * std::numbers::pi * t / 24.0 + phase);
        wandering += walk * stream.normal();
        const double tilt =
            kBias + history(t) + kSlope * (degc - 42.5) + wandering + white * stream.normal();
        stretch.times.push_back(UtcTime{} + from_seconds(3600.0 * t));
        stretch.temperature_degc.push_back(degc + 0.0015 * stream.normal());
        stretch.axes_mgal[0].push_back(kMilliGalPerStandardGravity * std::sin(1e-6 * tilt));
        stretch.axes_mgal[1].push_back(100.0 + 0.1 * stream.normal());
        stretch.axes_mgal[2].push_back(kMilliGalPerStandardGravity * std::cos(1e-6 * tilt));
        stretch.quantity.push_back(kMilliGalPerStandardGravity);
    }
    LongRecord record;
    record.stretches = {stretch};
    return record;
}

}  // namespace

TEST_CASE("a tilt is the angle of the axis above the horizontal") {
    for (const double angle : {-1.2, -1e-3, 0.0, 1e-6, 0.5})
        for (const double across : {0.0, 2.0}) {
            const double x = 979.8 * std::sin(angle), rest = 979.8 * std::cos(angle);
            const double y = rest * std::sin(across), z = rest * std::cos(across);
            CHECK(archive_series::tilt_urad({x, y, z}, 0) == Approx(1e6 * angle).margin(1e-7));
            CHECK(archive_series::tilt_urad({y, x, z}, 1) == Approx(1e6 * angle).margin(1e-7));
        }
    CHECK(archive_series::tilt_axis("tilt-y") == 1);
    CHECK_FALSE(archive_series::tilt_axis("BNZ").has_value());
}

TEST_CASE("a known history of tilts comes back, without the effect of the temperature") {
    const LongRecord record = tilt_record(tilted(18.0, 0.3, 0.0, 1, history_urad), 0);
    const RecordSegments parts = divide_record(record);
    REQUIRE(parts.segments.size() == 2);
    CHECK(parts.segments[1].begins_with.english().find("urad") != std::string::npos);
    const TiltFit fit = fit_tilt(parts, record.step_s, 0);
    CHECK(std::abs(fit.slope_urad_per_degc - kSlope) < 3.0 * fit.slope_error_urad_per_degc);
    CHECK(fit.slope_error_urad_per_degc < 2.5);
    CHECK(fit.noise.points.front().deviation_mgal.value == Approx(0.3).margin(0.1));
    const RecordStretch& stretch = record.stretches.front();
    for (std::size_t i = 0; i < stretch.size(); ++i) {
        const double degc = stretch.temperature_degc[i];
        const double truth = kBias + history_urad(kStep_h * static_cast<double>(i)) +
                             kSlope * (fit.temperature_degc - 42.5);
        const double found = fit.corrected_urad(stretch.quantity[i], degc);
        REQUIRE(std::abs(found - truth) < 5.0 * fit.u_urad(degc));
    }
}

TEST_CASE("limits of the effect of the temperature on the tilt contain it") {
    constexpr int kRecords = 100;
    int inside = 0;
    double squares = 0.0;
    for (int seed = 1; seed <= kRecords; ++seed) {
        const LongRecord record = tilt_record(
            tilted(24.0, 0.5, 0.03, static_cast<std::uint64_t>(seed), [](double) { return 0.0; }),
            0);
        const TiltFit fit = fit_tilt(divide_record(record), record.step_s, 0);
        const double error = (fit.slope_urad_per_degc - kSlope) / fit.slope_error_urad_per_degc;
        inside += std::abs(error) < 1.96 ? 1 : 0;
        squares += error * error;
    }
    std::printf("slope within its limits in %d of %d records, rms error / u %.2f\n", inside,
                kRecords, std::sqrt(squares / kRecords));
    CHECK(inside >= 90);
}

TEST_CASE("a tilt needs axes, and one that is horizontal") {
    const LongRecord record = tilted(4.0, 0.3, 0.0, 1, history_urad);
    LongRecord on_its_side = record;
    std::swap(on_its_side.stretches[0].axes_mgal[0], on_its_side.stretches[0].axes_mgal[2]);
    CHECK_THROWS_AS(tilt_record(on_its_side, 0), InputError);
    CHECK_NOTHROW(tilt_record(on_its_side, 1));
    LongRecord norm = record;
    norm.stretches[0].axes_mgal.clear();
    CHECK_THROWS_AS(tilt_record(norm, 0), InputError);
}

TEST_CASE("an axis that is not horizontal has no tilt") {
    const auto require = [](std::vector<double> tilts_urad) {
        archive_series::require_horizontal(std::move(tilts_urad), 1, "--channel");
    };
    CHECK_NOTHROW(require({}));
    CHECK_NOTHROW(require({-1e5, 1.5e6, 2e5}));  // one knock
    CHECK_THROWS_WITH(require({-1.5e6, -1.5e6, 0.0}),
                      "--channel = tilt-y: this axis is -85.9 deg from the horizontal; allowed: a "
                      "horizontal axis, within 45 deg");
}
