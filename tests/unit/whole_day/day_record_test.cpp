#include "corrector/reading/day_record.hpp"

#include <cmath>
#include <limits>
#include <random>
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::reading;

namespace {

const UtcTime kRecordStart = *parse_rfc3339("2026-05-01T00:00:00Z");
const Hertz kRate(50.0);

OccupationRecord still(double seconds, double z_g = 0.999) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> noise(0.0, 1e-5);
    const auto axis = [&](double value_g) {
        std::vector<double> samples(static_cast<std::size_t>(seconds * 50.0));
        for (double& sample : samples) sample = value_g + noise(random);
        return TimeSeries<StandardGravity>(kRecordStart, kRate, samples);
    };
    return {axis(0.001), axis(-0.002), axis(z_g), TimeSeries<DegC>(kRecordStart, kRate, {})};
}

std::optional<DayTemperature> of_raw(const std::vector<double>& degc) {
    return day_temperature(signal::decimate(TimeSeries<DegC>(kRecordStart, kRate, degc),
                                            signal::design_decimation(kDecimationFactor),
                                            kDecimationStages));
}

}  // namespace

TEST_CASE("bins contain the mean norm and the mean horizontal axes") {
    const auto bins = bin_set_up(3, decimate_axes(still(400.0)), 8.0);
    REQUIRE(bins.size() == 8);
    for (const DayBin& bin : bins) {
        CHECK(bin.set_up == 3);
        CHECK(bin.reading.value() ==
              Approx(980665.0 * std::sqrt(0.999 * 0.999 + 5e-6)).epsilon(0.0).margin(1.5));
        CHECK(bin.x.value() == Approx(0.001).margin(2e-6));
        CHECK(bin.y.value() == Approx(-0.002).margin(2e-6));
    }
    CHECK(bins[2].times.size() == kBinSamples);
    CHECK(seconds_between(kRecordStart, bins[2].time) == Approx(124.0));
}

TEST_CASE("a day has two faces if one of its set-ups was turned over") {
    std::vector<DayBin> bins;
    for (const std::size_t set_up : {0U, 1U}) {
        const double z_g = set_up == 0 ? 0.999 : -0.999;
        for (DayBin& bin : bin_set_up(set_up, decimate_axes(still(60.0, z_g)), 8.0)) {
            bin.face = set_up == 0 ? 1.0 : -1.0;
            CHECK(bin.reading.value() > 0.0);
            bins.push_back(std::move(bin));
        }
        CHECK(has_two_faces(bins) == (set_up == 1));
    }
    CHECK(faces_of(bins, 3) == std::vector{1.0, -1.0, 1.0});
}

TEST_CASE("samples near a disturbance are left out of the bins") {
    OccupationRecord record = still(400.0);
    std::vector<double> z = record.z.values();
    for (std::size_t i = 7400; i < 7500; ++i) z[i] += 0.01;  // 148 to 150 s
    record.z = {kRecordStart, kRate, z};
    for (const DayBin& bin : bin_set_up(0, decimate_axes(record), 8.0)) {
        for (const UtcTime time : bin.times)
            CHECK(std::abs(seconds_between(kRecordStart, time) - 149.0) > 10.0);
        CHECK(bin.reading.value() == Approx(979686.0).epsilon(0.0).margin(5.0));
    }
}

TEST_CASE("a bin with few samples is left out") {
    OccupationRecord record = still(100.0);
    std::vector<double> z = record.z.values();
    std::fill(z.begin() + 1000, z.begin() + 2600, std::numeric_limits<double>::quiet_NaN());
    record.z = {kRecordStart, kRate, z};
    const auto bins = bin_set_up(0, decimate_axes(record), 8.0);
    REQUIRE(bins.size() == 1);
    CHECK(seconds_between(kRecordStart, bins[0].times.front()) > 60.0);
}

TEST_CASE("the day's temperature is smooth, and its gaps are bridged") {
    std::mt19937_64 random(6);
    std::normal_distribution<double> noise(0.0, 0.01);
    std::vector<double> degc(180000);  // an hour
    for (std::size_t i = 0; i < degc.size(); ++i)
        degc[i] = 42.0 + 1e-6 * static_cast<double>(i) + noise(random);
    std::fill(degc.begin() + 60000, degc.begin() + 75000,
              std::numeric_limits<double>::quiet_NaN());  // 300 s
    const auto day = of_raw(degc);
    REQUIRE(day);
    CHECK(day->longest_gap_s() == Approx(318.0).margin(4.0));
    const double late_s = seconds_between(kRecordStart, day->series.start());
    for (std::size_t i = 0; i < day->series.size(); ++i) {
        const double exact = 42.0 + 1e-6 * 50.0 * (late_s + 2.0 * static_cast<double>(i));
        REQUIRE(day->series.values()[i] == Approx(exact).margin(0.0015));
    }
}

TEST_CASE("a few minutes of temperature, or none, are too short for a day") {
    CHECK_FALSE(of_raw(std::vector<double>(25000, 42.0)));
    CHECK_FALSE(of_raw(std::vector<double>(90000, std::numeric_limits<double>::quiet_NaN())));
}
