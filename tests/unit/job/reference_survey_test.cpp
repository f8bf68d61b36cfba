#include "corrector/job/reference_survey.hpp"

#include <fmt/core.h>

#include "tests/support/catch.hpp"

#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::corrector;
using namespace a351::corrector::job;

namespace {

const std::vector<std::string> kSites{"A", "B", "C"};
constexpr double kStep_mgal = 80.0;

/// A survey of the sensor at A, B and C, and a gravimeter that reads A, B, C, B, A with this scale.
struct Pair {
    test::TemporaryDirectory folder;
    SurveyFile survey;
    reading::OccupationRows read;

    explicit Pair(double scale = 1.0, const std::string& end = ",M1\n") {
        std::string csv =
            "site,occupation,time_utc,acceleration_mgal,earth_tide_mgal,temperature_degc,"
            "instrument\n";
        int hour = 0;
        for (const std::size_t k : {0U, 1U, 2U, 1U, 0U}) {
            csv += fmt::format("{},{},2026-05-01T{:02}:00:00Z,{},0,", kSites[k], hour / 3 + 1, hour,
                               2500.0 + scale * kStep_mgal * static_cast<double>(k));
            csv += end;
            ++hour;
        }
        survey.sites =
            folder.write("sites.csv", "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\n");
        survey.reference.emplace();
        survey.reference->observations = folder.write("meter.csv", csv);
        survey.reference->priors.reading_sd_mgal = adjustment::kGravimeterReadingSd_mgal;
        for (std::size_t k = 0; k < kSites.size(); ++k) {
            text::Site site;
            site.name = kSites[k];
            read.sites.push_back(site);
            reading::SurveyRow& row = read.rows.emplace_back();
            row.site = kSites[k];
            row.acceleration = MilliGal(981000.0 + kStep_mgal * static_cast<double>(k));
            row.time = *parse_rfc3339("2026-05-01T00:00:00Z") + std::chrono::hours(k);
        }
    }
    void publish(std::size_t site, double gravity_mgal) {
        read.sites[site].gravity = MilliGal(gravity_mgal);
        read.rows[site].reference = MilliGal(gravity_mgal);
    }
};

}  // namespace

TEST_CASE("without published gravity the gravimeter gives differences at the level of the sensor") {
    Pair pair;
    const auto network = hold_reference_values(pair.survey, pair.read);
    CHECK_FALSE(network.network.is_level_known);
    for (std::size_t k = 0; k < kSites.size(); ++k) {
        const double gravity = 981000.0 + kStep_mgal * static_cast<double>(k);
        CHECK(pair.read.rows[k].reference->value() == Approx(gravity).epsilon(0).margin(1e-6));
        CHECK(pair.read.sites[k].gravity == pair.read.rows[k].reference);
    }
    // The scale of the gravimeter, 5e-4, is 0.08 mGal at C.
    CHECK(pair.read.rows[2].u_reference->value() > 0.08);
    CHECK(pair.read.rows[2].u_reference->value() < 0.083);
}

TEST_CASE("published gravity gives the level, and the scale of the gravimeter if there are two") {
    Pair pair(1.001);
    pair.publish(0, 979900.0);
    pair.publish(2, 979900.0 + 2.0 * kStep_mgal);
    adjustment::set_prior(pair.survey.reference->priors, "test", adjustment::kScale, {1.0, 0.05});
    const auto network = hold_reference_values(pair.survey, pair.read);
    CHECK(network.network.is_level_known);
    CHECK(pair.read.rows[1].reference->value() ==
          Approx(979900.0 + kStep_mgal).epsilon(0).margin(1e-4));
    REQUIRE(network.network.scales.size() == 1);
    CHECK(network.network.scales[0].value - 1.0 == Approx(0.001).epsilon(1e-4));
}

TEST_CASE("the comparison has the stations of both and the uncertainty of the gravimeter's scale") {
    Pair pair;
    const auto network = hold_reference_values(pair.survey, pair.read);
    model::SurveyCorrection result;
    result.scales.push_back({"", 1.002, 3e-4, adjustment::kSensorScale});
    result.coefficients.push_back({"constant_mgal", 12.0, 1.0});
    for (const std::string site : {"A", "C", "D"}) {
        model::StationValue& station = result.stations.emplace_back();
        station.site = site;
        station.left_out = MilliGal(981001.0 + (site == "C" ? 2.0 * kStep_mgal : 0.0));
        station.u_left_out = MilliGal(1.5);
    }
    compare_with_reference(result, network);
    const model::SideBySide& both = result.side_by_side.value();
    REQUIRE(both.stations.size() == 2);
    CHECK(both.stations[1].site == "C");
    CHECK(both.scatter_mgal().value() == Approx(1.0).margin(1e-6));
    CHECK_FALSE(both.bias);  // the level is that of the sensor
    CHECK(result.scales[0].u == Approx(std::hypot(3e-4, 5e-4)).epsilon(1e-2));
}

TEST_CASE("a table that is not of a gravimeter, or has no common station, is refused") {
    Pair other;
    for (reading::SurveyRow& row : other.read.rows) row.site = "elsewhere";
    CHECK_THROWS_WITH(hold_reference_values(other.survey, other.read),
                      ContainsSubstring("no station in common"));
    Pair sensor;
    sensor.survey.reference->observations =
        sensor.folder.write("sensor.csv",
                            "site,occupation,time_utc,acceleration_mgal,temperature_degc\n"
                            "A,1,2026-05-01T00:00:00Z,979900,42\n");
    CHECK_THROWS_WITH(hold_reference_values(sensor.survey, sensor.read),
                      ContainsSubstring("no column instrument"));
}
