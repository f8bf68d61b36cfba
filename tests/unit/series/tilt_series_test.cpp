#include "corrector/series/tilt_series.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"

using namespace a351;
using namespace a351::corrector::series;
using namespace a351::corrector::reading;
using namespace a351::unit;

namespace {

const Eigen::Vector3d kBiases_mgal(-1200.0, 700.0, 1838.0);
constexpr double kTiltedGravity_mgal = 979763.0;
constexpr std::size_t kBins = 10;

/// Tilt angles of a set-up, degrees.
struct Tilt {
    double x, y;
};

const std::vector<Tilt> kThereAndBack{{0, 0}, {2, 0},  {-2, 0}, {0, 2},  {0, -2}, {0, 0},
                                      {0, 0}, {0, -2}, {0, 2},  {-2, 0}, {2, 0},  {0, 0}};

/// Returns set-ups of ten minutes, one after another.
OccupationRows tilted_series(const std::vector<Tilt>& tilts, double placement_mgal = 0.0,
                             double degc_per_set_up = 0.0) {
    const UtcTime start = *parse_rfc3339("2026-05-01T00:00:00Z");
    constexpr double kStay_s = 600.0;
    std::vector<double> degc(300 * (tilts.size() + 1));
    for (std::size_t i = 0; i < degc.size(); ++i)
        degc[i] = 42.45 + degc_per_set_up * static_cast<double>(i) / 300.0;
    OccupationRows read;
    read.day = DayRecord{{{start, Hertz(0.5), degc}, {}}, {}};
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    for (std::size_t s = 0; s < tilts.size(); ++s) {
        const double x = std::sin(tilts[s].x * std::numbers::pi / 180.0);
        const double y = std::sin(tilts[s].y * std::numbers::pi / 180.0);
        const Eigen::Vector3d vector =
            kTiltedGravity_mgal * Eigen::Vector3d(x, y, std::sqrt(1.0 - x * x - y * y)) +
            kBiases_mgal;
        const double placement = placement_mgal * normal(random);
        const UtcTime begin = start + from_seconds(kStay_s * static_cast<double>(s) + 60.0);
        for (std::size_t b = 0; b < kBins; ++b) {
            DayBin bin;
            bin.set_up = s;
            for (std::size_t i = 0; i < kBinSamples; ++i)
                bin.times.push_back(begin +
                                    from_seconds(2.0 * static_cast<double>(b * kBinSamples + i)));
            bin.time = bin.times[kBinSamples / 2];
            bin.reading = MilliGal(vector.norm() + placement + 0.01 * normal(random));
            bin.x = to_standard_gravity(MilliGal(vector(0)));
            bin.y = to_standard_gravity(MilliGal(vector(1)));
            read.day->bins.push_back(bin);
        }
        SurveyRow row;
        row.site = "laboratory";
        row.time = begin;
        row.reference = MilliGal(kTiltedGravity_mgal);
        row.temperature = DegC(42.45 + degc_per_set_up * static_cast<double>(s));
        read.rows.push_back(row);
    }
    return read;
}

std::string refusal_of_tilts(const OccupationRows& read) {
    try {
        static_cast<void>(measure_axis_bias(read, "tilt"));
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

}  // namespace

TEST_CASE("a tilt series gives the biases it was made with") {
    const TiltSeries found = measure_axis_bias(tilted_series(kThereAndBack), "tilt");
    CHECK(found.set_ups == 12);
    // The margin covers 0.01 mGal of noise and the small error of the bias of z.
    CHECK(found.bias.values(0) == Approx(kBiases_mgal(0)).margin(0.5));
    CHECK(found.bias.values(1) == Approx(kBiases_mgal(1)).margin(0.5));
    CHECK(found.greatest_tilt_deg[0] == Approx(2.0).margin(0.1));
}

TEST_CASE("without the site's gravity the biases are the same") {
    OccupationRows read = tilted_series(kThereAndBack);
    for (SurveyRow& row : read.rows) row.reference.reset();
    const TiltSeries found = measure_axis_bias(read, "tilt");
    CHECK(found.bias.values(0) == Approx(kBiases_mgal(0)).margin(2.0));
    CHECK(found.bias.values(1) == Approx(kBiases_mgal(1)).margin(2.0));
}

TEST_CASE("the scatter of set-ups becomes the error of the biases") {
    const TiltSeries found = measure_axis_bias(tilted_series(kThereAndBack, 1.2), "tilt");
    // 1.2 mGal over four set-ups at 2 degrees each: 1.2 / (0.0349 sqrt 4) = 17.
    CHECK(std::sqrt(found.bias.covariance(0, 0)) == Approx(17.0).epsilon(0.4));
    CHECK(std::abs(found.bias.values(0) - kBiases_mgal(0)) < 3.0 * 17.0);
    CHECK(std::abs(found.bias.values(1) - kBiases_mgal(1)) < 3.0 * 17.0);

    const AxisBias twice = combine({found, found});
    CHECK(twice.values(0) == Approx(found.bias.values(0)));
    CHECK(twice.covariance(0, 0) == Approx(found.bias.covariance(0, 0) / 2.0));
    CHECK(twice.covariance == twice.covariance.transpose());
}

TEST_CASE("a flagged set-up is not used") {
    OccupationRows read = tilted_series(kThereAndBack);
    read.rows[3].is_flagged = true;
    for (DayBin& bin : read.day->bins)
        if (bin.set_up == 3) bin.reading = bin.reading + MilliGal(1e5);
    const TiltSeries found = measure_axis_bias(read, "tilt");
    CHECK(found.set_ups == 11);
    CHECK(found.bias.values(1) == Approx(kBiases_mgal(1)).margin(2.0));
}

TEST_CASE("a tilt series that does not determine the biases is refused with the reason") {
    CHECK_THAT(refusal_of_tilts(tilted_series({{0, 0}, {2, 0}, {-2, 0}, {0, 2}, {0, -2}})),
               ContainsSubstring("tilt: tilt series: 5 set-ups; allowed: 6 or more"));
    CHECK_THAT(refusal_of_tilts(tilted_series({{0, 0}, {2, 0}, {-2, 0}, {2, 0}, {-2, 0}, {0, 0}})),
               ContainsSubstring("y is tilted from 0.04 to 0.04 deg; allowed: both axes"));
    CHECK_THAT(refusal_of_tilts(tilted_series({{0, 0}, {2, 0}, {0, 2}, {0, -2}, {2, 0}, {0, 0}})),
               ContainsSubstring("x is tilted from -0.07 to 1.93 deg"));
    CHECK_THAT(
        refusal_of_tilts(tilted_series({{0, 0}, {2, 2}, {-2, -2}, {2, 2}, {-2, -2}, {0, 0}})),
        ContainsSubstring("x and y are tilted together"));
    CHECK_THAT(refusal_of_tilts(tilted_series(kThereAndBack, 0.0, 0.05)),
               ContainsSubstring("the temperature moved by 0.55 degC between set-ups"));
    OccupationRows read = tilted_series(kThereAndBack);
    read.rows[4].site = "roof";
    CHECK_THAT(refusal_of_tilts(read), ContainsSubstring("set-ups at laboratory and roof"));
    read = tilted_series(kThereAndBack);
    read.day.reset();
    CHECK_THAT(refusal_of_tilts(read),
               ContainsSubstring("needs the record of the day's temperature"));
}
