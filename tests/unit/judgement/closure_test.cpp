#include "corrector/judgement/closure.hpp"

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::judgement;

namespace {

CorrectedRow row(const std::string& site, int occupation, const std::string& time,
                 double acceleration_mgal) {
    CorrectedRow row;
    row.row.site = site;
    row.row.occupation = occupation;
    row.row.time = parse_rfc3339(time).value();
    row.row.acceleration = MilliGal(acceleration_mgal);
    return row;
}

/// Returns two stays at B two hours apart, the second with two set-ups, and one stay at S.
SurveyCorrection survey() {
    SurveyCorrection result;
    result.rows = {row("B", 1, "2020-05-01T00:00:00Z", 981700.0),
                   row("S", 1, "2020-05-01T01:00:00Z", 981600.0),
                   row("B", 2, "2020-05-01T02:00:00Z", 981694.0),
                   row("B", 2, "2020-05-01T02:15:00Z", 981697.0)};
    const double tide_mgal[] = {0.02, 0.0, -0.03, -0.04};
    const double temperature_mgal[] = {-1800.0, -1800.0, -1796.5, -1798.5};
    const double rate_mgal[] = {0.25, 0.0, -0.75, 0.25};
    const double drift_mgal[] = {0.0, 1.0, 2.0, 2.25};
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        CorrectedRow& out = result.rows[i];
        out.row.tide = MilliGal(tide_mgal[i]);
        out.temperature_correction = MilliGal(temperature_mgal[i]);
        out.rate_correction = MilliGal(rate_mgal[i]);
        out.drift_correction = MilliGal(drift_mgal[i]);
        out.corrected = out.row.reduced() + out.temperature_correction + out.rate_correction +
                        out.drift_correction;
    }
    for (const char* const site : {"B", "S"}) {
        StationValue& station = result.stations.emplace_back();
        station.site = site;
    }
    return result;
}

double value(MilliGal quantity) { return quantity.value(); }

}  // namespace

TEST_CASE("a difference explained by tilt does not count as drift") {
    SurveyCorrection result = survey();
    const double before = close_stations(result)[0].drift_mgal_per_h.value();
    result.rows[2].tilt_correction = MilliGal(3.0);
    CHECK(close_stations(result)[0].drift_mgal_per_h.value() == Approx(before + 1.5));
}

TEST_CASE("each pair of readings of a station has its difference after each correction") {
    const std::vector<Closure> closures = close_stations(survey());
    REQUIRE(closures.size() == 3);
    const Closure& pair = closures[0];
    CHECK(pair.earlier == 0);
    CHECK(pair.later == 2);
    CHECK(pair.hours == Approx(2.0));
    CHECK(value(pair.before) == Approx(-6.0));
    CHECK(value(pair.after_tide) == Approx(-5.95));         // -6 - (-0.03 - 0.02)
    CHECK(value(pair.after_temperature) == Approx(-2.45));  // + 3.5
    CHECK(value(pair.after_rate) == Approx(-3.45));         // - 1
    CHECK(value(pair.after_all) == Approx(-1.45));          // + 2
    CHECK(pair.drift_mgal_per_h.value() == Approx(-1.725));
    CHECK(closures[1].later == 3);
}

TEST_CASE("set-ups of one stay imply no drift") {
    const Closure pair = close_stations(survey())[2];
    CHECK(pair.earlier == 2);
    CHECK(pair.later == 3);
    CHECK(value(pair.before) == Approx(3.0));
    CHECK_FALSE(pair.drift_mgal_per_h.has_value());
}

TEST_CASE("the RMS of the closures is the RMS of their differences") {
    auto closures = close_stations(survey());
    closures.pop_back();
    closures[1].before = MilliGal(8.0);
    CHECK(value(rms_of(closures, &Closure::before)) == Approx(std::sqrt(50.0)));  // -6 and 8
}
