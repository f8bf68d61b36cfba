// A made-up morning written as miniSEED, StationXML and occupations, and averaged from there.
#include "tests/unit/reading/morning.hpp"

#include "corrector/job/survey_readings.hpp"
#include "corrector/job/survey_units.hpp"
#include "protocol/core/input_error.hpp"

using namespace a351;
using namespace a351::corrector::job;
using namespace a351::corrector;
using namespace a351::corrector::reading;
using namespace a351::corrector::tide;
using namespace std::chrono_literals;

namespace {

constexpr std::chrono::seconds kStay = Morning::kStay;
const std::vector<std::string>& kMorningSites = Morning::kSites;

SurveyFile survey_of(const Morning& morning,
                     const std::string& keys = "tide='none'\noccupations='occupations.csv'\n") {
    return read_survey_file(morning.folder().write("day.toml", "[survey]\n" + keys));
}

OccupationRows read(const SurveyFile& survey) {
    return read_survey(survey, [](std::size_t, std::size_t) {});
}

OccupationRows average(const Morning& morning,
                       const std::string& keys = "occupations='occupations.csv'\n") {
    return read(survey_of(morning, "tide='none'\n" + keys));
}

/// Returns the readings of a list of occupations.
OccupationRows average_listed(const Morning& morning, const std::string& rows) {
    morning.folder().write("other.csv", "site,occupation,start_utc,end_utc,used,note\n" + rows);
    return average(morning, "occupations='other.csv'\n");
}

/// Logs the stays; the last one without its stop.
void log_stays(const Morning& morning, bool has_last_stop) {
    for (std::size_t i = 0; i < kMorningSites.size(); ++i) {
        morning.log(Morning::start_event(i));
        if (has_last_stop || i + 1 < kMorningSites.size()) morning.log(Morning::stop_event(i));
    }
}

void check_same_readings(const OccupationRows& a, const OccupationRows& b) {
    REQUIRE(a.rows.size() == b.rows.size());
    for (std::size_t i = 0; i < a.rows.size(); ++i) {
        CHECK(a.rows[i].acceleration == b.rows[i].acceleration);
        CHECK(a.rows[i].temperature == b.rows[i].temperature);
        CHECK(a.rows[i].occupation == b.rows[i].occupation);
    }
}

}  // namespace

TEST_CASE("occupations read from the archive have the values that were written") {
    Morning morning;
    const OccupationRows result = average(morning);
    CHECK(result.warnings.empty());
    REQUIRE(result.rows.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
        CAPTURE(i);
        const SurveyRow& row = result.rows[i];
        CHECK(row.site == kMorningSites[i]);
        CHECK(row.occupation == (i == 3 ? 2 : 1));
        CHECK(row.is_flagged == (i == 2));
        CHECK(row.reference == MilliGal(Morning::kGravity_mgal[i]));
        CHECK(row.start.value() >= Morning::start_of(i));
        CHECK(row.end.value() <= Morning::start_of(i) + kStay);
        // The value at the middle differs from the mean by the curvature of the temperature, 0.4
        // degC (75 s / 900 s)^2 / 6; the trend's ends and the quantisation give the rest.
        const double middle = seconds_between(Morning::kBegin, row.time);
        CHECK(row.temperature.value() ==
              Approx(Morning::temperature_degc(middle)).epsilon(0).margin(0.001));
        CHECK(row.acceleration.value() ==
              Approx(Morning::reading_mgal(middle)).epsilon(0).margin(0.03));
        const double rate = 0.4 / 900.0 * std::cos(middle / 900.0) * 3600.0;
        CHECK(row.rate_degc_per_h == Approx(rate).epsilon(0).margin(0.01));
    }
}

TEST_CASE("the result contains the record of each row and the temperature of the day") {
    Morning morning;
    const OccupationRows result = average(morning);
    constexpr double kHalfCount_degc = 0.0019;  // near the top the temperature stays on one count
    REQUIRE(result.records.size() == result.rows.size());
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const RepresentativeValue& record = result.records[i];
        CHECK(record.interval_start == result.rows[i].start);
        CHECK(record.curve_mean == result.rows[i].acceleration);
        REQUIRE(record.temperature_series.size() == record.series.size());
        const double middle = seconds_between(Morning::kBegin, record.series.time_of(37.0));
        CHECK(record.temperature_series.values()[37] ==
              Approx(Morning::temperature_degc(middle)).epsilon(0).margin(kHalfCount_degc));
    }
    // From a minute before the first start to a minute after the last stop, as far as there is a
    // record.
    REQUIRE(result.temperature_course.size() == 16);
    for (const archive_series::MinuteTemperature& minute : result.temperature_course) {
        const double seconds = seconds_between(Morning::kBegin, minute.middle);
        CHECK(minute.mean.value() ==
              Approx(Morning::temperature_degc(seconds)).epsilon(0).margin(kHalfCount_degc));
    }
}

TEST_CASE("a face that was entered wrong is a finding, and the data decide") {
    Morning morning;
    std::string rows = "site,occupation,start_utc,end_utc,face\n";
    for (std::size_t i = 0; i < 4; ++i) {
        const UtcTime start = Morning::start_of(i);
        rows += kMorningSites[i] + (i == 3 ? ",2," : ",1,") + to_rfc3339(start) + ',' +
                to_rfc3339(start + kStay) +
                (i == 1   ? ",-\n"
                 : i == 2 ? ",+\n"
                          : ",\n");
    }
    morning.folder().write("faces.csv", rows);
    const OccupationRows result = average(morning, "occupations='faces.csv'\n");
    REQUIRE(result.findings.size() == 1);
    CHECK(result.findings[0].kind == FindingKind::turned);
    CHECK(result.findings[0].site == kMorningSites[1]);
    CHECK(std::ranges::all_of(result.rows, [](const SurveyRow& row) { return row.face == 1; }));
}

TEST_CASE("two runs over the same archive are bit-identical") {
    Morning morning;
    const auto a = average(morning);
    const auto b = average(morning);
    check_same_readings(a, b);
    REQUIRE(a.inputs.size() == b.inputs.size());
    CHECK(a.inputs.size() == 4 + 8);  // survey, sites, metadata, occupations; 4 channels, 2 days
}

TEST_CASE("occupations are read from the event log if no table is given") {
    Morning morning;
    log_stays(morning, true);
    const auto logged = average(morning, "");
    const auto listed = average(morning);
    check_same_readings(logged, listed);
}

TEST_CASE("the last stay of a log without a stop lasts until the end of the record") {
    Morning morning;
    log_stays(morning, false);
    const auto result = average(morning, "");
    REQUIRE(result.rows.size() == kMorningSites.size());
    const UtcTime end = Morning::kBegin + static_cast<int>(kMorningSites.size()) * Morning::kCycle;
    CHECK(std::chrono::abs(*result.rows.back().end - end) < 30s);
    CHECK(std::ranges::count(result.rows.back().notes, "gap") == 0);
    REQUIRE(result.findings.size() == 1);
    const Finding& finding = result.findings[0];
    CHECK(finding.kind == FindingKind::no_stop);
    CHECK(finding.code == "no_stop_last");
    CHECK(finding.site == kMorningSites.back());
    CHECK(finding.key == "20200502T000220Z");
    CHECK_FALSE(finding.is_headline);
    CHECK(finding.text == "B (2) has no stop: it lasts until the end of the record, at " +
                              to_rfc3339(*finding.time));
    CHECK(std::chrono::abs(*finding.time - end) < 1s);
}

TEST_CASE("an occupation outside the archive is left out and reported") {
    Morning morning;
    const auto result = average_listed(morning,
                                       "B,1,2020-05-01T23:50:20Z,2020-05-01T23:52:50Z,1,\n"
                                       "S1,1,2020-05-02T03:00:00Z,2020-05-02T03:10:00Z,1,\n");
    CHECK(result.rows.size() == 1);
    REQUIRE(result.warnings.size() == 1);
    CHECK(result.warnings[0] == "S1 (1) at 2020-05-02T03:00:00Z is left out: no samples");
}

TEST_CASE("a stay with values of a wrong profile is left out, and the others do not see them") {
    const auto right = average(Morning());
    for (const auto sensors :
         {Morning::Sensors::wrong_scale, Morning::Sensors::wrong_temperature}) {
        Morning morning(sensors);
        const auto result = average(morning);
        REQUIRE(result.rows.size() == 3);
        REQUIRE(result.left_out.size() == 1);
        CHECK_THAT(result.left_out[0].reason, ContainsSubstring("a351-correct retime --profile"));
        for (std::size_t i = 0; i < 3; ++i)
            CHECK(result.rows[i].acceleration == right.rows[i].acceleration);
        for (const double degc : result.day.value().temperature.series.values())
            CHECK(std::abs(degc - 42.3) < 0.5);
        for (const auto& minute : result.temperature_course)
            CHECK(std::abs(minute.mean.value() - 42.3) < 0.5);
        CHECK_THROWS_WITH(
            average_listed(morning, "B,1,2020-05-02T00:02:20Z,2020-05-02T00:04:50Z,1,\n"),
            ContainsSubstring("no occupation can be used: no sensor sends such values") &&
                ContainsSubstring("a351-correct retime --profile"));
    }
}

TEST_CASE("a survey without any sample is refused") {
    Morning morning;
    CHECK_THROWS_AS(average_listed(morning, "B,1,2021-05-01T23:50:20Z,2021-05-01T23:52:50Z,1,\n"),
                    InputError);
}

TEST_CASE("the tide of a row is that of the middle of its interval") {
    Morning morning;
    const auto result =
        read(survey_of(morning, "occupations='occupations.csv'\ndelta2=1.2\ndelta3=1.2\n"));
    for (const SurveyRow& row : result.rows) {
        const UtcTime middle = *row.start + (*row.end - *row.start) / 2;
        const auto sites = text::read_sites(morning.folder().path() / "sites.csv");
        const auto* site = text::find_site(sites, row.site);
        CHECK(row.tide ==
              direct_tide(middle, {site->latitude, site->longitude, site->altitude}, {1.2, 1.2}));
    }
}

TEST_CASE("a day with an exchange is one survey for each sensor, each with its own readings") {
    const Morning morning(Morning::Sensors::exchanged);
    const SurveyFile day = survey_of(morning);
    CHECK_THROWS_WITH(read(day), ContainsSubstring("several sensors (00000001, 00000777)"));

    const std::vector<SurveyFile> parts = by_unit(day);
    REQUIRE(parts.size() == 2);
    for (std::size_t part = 0; part < 2; ++part) {
        CAPTURE(part);
        const OccupationRows own = read(parts[part]);
        CHECK(parts[part].name == (part == 0 ? "day-00000001" : "day-00000777"));
        CHECK(own.serial_number == (part == 0 ? "00000001" : "00000777"));
        REQUIRE(own.rows.size() == 2);
        for (std::size_t i = 0; i < 2; ++i) {
            const SurveyRow& row = own.rows[i];
            CHECK(row.site == kMorningSites[2 * part + i]);
            const double written =
                Morning::reading_mgal(seconds_between(Morning::kBegin, row.time));
            CHECK(
                row.acceleration.value() ==
                Approx(written + (part == 0 ? 0.0 : Morning::kOther_mgal)).epsilon(0).margin(0.1));
        }
        const auto finding =
            std::ranges::find(own.findings, FindingKind::other_unit, &Finding::kind);
        REQUIRE(finding != own.findings.end());
        CHECK(finding->time == Morning::kBegin + Morning::kExchange);
        CHECK_THAT(finding->text.english(),
                   ContainsSubstring("00000001, 00000777 2020-05-01T23:58:00Z; these are the "
                                     "readings of " +
                                     own.serial_number));
        // No temperature of the other sensor.
        REQUIRE_FALSE(own.temperature_course.empty());
        const UtcTime exchange = Morning::kBegin + Morning::kExchange;
        CHECK((own.temperature_course.front().middle < exchange) == (part == 0));
        CHECK((own.temperature_course.back().middle < exchange) == (part == 0));
    }
}

TEST_CASE("a stay during which the sensor was exchanged ends there") {
    const Morning morning(Morning::Sensors::exchanged);
    morning.folder().write("occupations.csv",
                           "site,occupation,start_utc,end_utc,used,note\n"
                           "B,1,2020-05-01T23:50:20Z,2020-05-01T23:52:50Z,,\n"
                           "S1,1,2020-05-01T23:54:20Z,2020-05-02T00:00:50Z,,\n"
                           "B,2,2020-05-02T00:02:20Z,2020-05-02T00:04:50Z,,\n");
    const std::vector<SurveyFile> parts = by_unit(survey_of(morning));
    REQUIRE(parts.size() == 2);
    CHECK(read_survey_inputs(parts[0]).list.windows.back().end ==
          Morning::kBegin + Morning::kExchange);
    const OccupationRows first = read(parts[0]);
    REQUIRE(first.rows.size() == 2);
    CHECK(first.rows[1].end.value() <= Morning::kBegin + Morning::kExchange);
    CHECK(read(parts[1]).rows.size() == 1);
}

TEST_CASE("a calibration is used for its sensor alone") {
    const Morning morning(Morning::Sensors::exchanged);
    SurveyFile day = survey_of(morning);
    day.survey.calibration.emplace().serial_number = "00000777";
    const std::vector<SurveyFile> parts = by_unit(day);
    REQUIRE(parts.size() == 2);
    CHECK_FALSE(parts[0].survey.calibration);
    CHECK(parts[1].survey.calibration);
    CHECK(read(parts[0]).warnings.at(0) ==
          "the calibration is of the sensor 00000777: it is not used for the readings of 00000001");
}
