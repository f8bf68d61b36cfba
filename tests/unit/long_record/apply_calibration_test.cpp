/// A calibration applied to simulated records, and its statistics on known series.
#include <cmath>

#include "corrector/long_record/apply_calibration.hpp"
#include "tests/unit/long_record/simulated_record.hpp"

using namespace a351;
using namespace a351::corrector;
using namespace a351::corrector::long_record;
using namespace a351::unit;

namespace {

/// Returns the true response of the scenarios' plant, with small errors.
ThermalResponse true_response() {
    ThermalResponse truth;
    truth.values << -12.0, -20.0, 950.0 * 43.0 / 3600.0, std::log(43.0), std::log(2700.0);
    truth.covariance *= 1e-6;
    return truth;
}

RecordAnalysis analysed(const RecordSegment& segment) {
    RecordAnalysisOptions options;
    options.ensemble_size = 20;
    return analyse_record(segment, kRecordStep_s, options);
}

constexpr double kAveraged_s = 1500.0;

}  // namespace

TEST_CASE("the unit's own response reduces the oven's cycle in a record") {
    for (const std::uint64_t seed : {731U, 732U}) {
        const RecordSegment segment = simulated_segment("indoor", seed);
        const AppliedCalibration applied =
            apply_calibration(true_response(), segment, analysed(segment), kAveraged_s);
        CHECK(applied.remarks.empty());
        REQUIRE(applied.bands.size() == 6);
        const BandScatter& cycle = applied.bands[2];
        CHECK(cycle.shortest_s == 600.0);
        CAPTURE(seed, cycle.rms_mgal.before, cycle.rms_mgal.parametric, cycle.rms_mgal.by_modes);
        // The scenario's resonant part, 1.4 mGal, has no counterpart in the temperature.
        CHECK(cycle.rms_mgal.parametric < 0.85 * cycle.rms_mgal.before);
        CHECK(cycle.rms_mgal.by_modes < 0.6 * cycle.rms_mgal.before);
        for (std::size_t i = 0; i < applied.allan.size(); ++i)
            CHECK(applied.allan[i].averaging_s == 20.0 * std::pow(2.0, i));
    }
}

TEST_CASE("a part that the calibration leaves open is not applied, with a remark") {
    const RecordSegment segment = simulated_segment("indoor", 733);
    ThermalResponse open = true_response();
    open.values.head<3>() << 500.0, 500.0, 300.0;
    open.covariance.diagonal().head<3>() << 36e6, 36e6, 9e6;
    const RecordAnalysis analysis = analysed(segment);
    const AppliedCalibration applied = apply_calibration(open, segment, analysis, kAveraged_s);
    CHECK(applied.remarks.size() == 2);
    CHECK(applied.parametric_mgal == segment.quantity);
}

TEST_CASE("a sine that only the temperature rate explains is removed by the two-path response") {
    RecordSegment segment;
    for (int i = 0; i < 2160; ++i) {
        const double angle = 2.0 * M_PI * 20.0 * i / 1800.0;
        const double turn = 2.0 * M_PI / 1800.0 * 43.0;
        // 10 mGal/(degC/h) with a lag of 43 s.
        segment.temperature_degc.push_back(42.5 + 0.02 * std::sin(angle));
        segment.quantity.push_back(0.02 * 10.0 * 3600.0 * 2.0 * M_PI / 1800.0 /
                                   (1.0 + turn * turn) *
                                   (std::cos(angle) + turn * std::sin(angle)));
    }
    ThermalResponse response = true_response();
    response.values << 0.0, 0.0, 10.0, std::log(43.0), std::log(2700.0);
    const AppliedCalibration applied =
        apply_calibration(response, segment, analysed(segment), kAveraged_s);
    const ThreeWays& rms = applied.bands[3].rms_mgal;
    CAPTURE(rms.before, rms.parametric, rms.by_modes);
    CHECK(rms.before == Approx(2.51 / std::sqrt(2.0)).epsilon(0.02));
    CHECK(rms.parametric < 0.02 * rms.before);
    CHECK(rms.by_modes < 0.25 * rms.before);
}

TEST_CASE(
    "the Allan deviations of a ramp and of alternating samples have their theoretical values") {
    std::vector<double> ramp, alternating;
    for (int i = 0; i < 64; ++i) {
        ramp.push_back(0.5 * i);
        alternating.push_back(i % 2 == 0 ? 1.0 : -1.0);
    }
    // Slope x averaging time / sqrt(2).
    CHECK(noise::allan_deviation(ramp, 4) == Approx(0.5 * 4 / std::sqrt(2.0)));
    CHECK(noise::allan_deviation(alternating, 1) == Approx(std::sqrt(2.0)));
    CHECK(noise::allan_deviation(alternating, 2) == Approx(0.0).margin(1e-12));
}
