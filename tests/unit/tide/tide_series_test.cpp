#include "corrector/tide/tide_series.hpp"

#include <nlohmann/json.hpp>

#include "corrector/tide/tide_choice.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/csv.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/model/survey_rows.hpp"

using namespace a351::corrector;
using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;
using namespace a351::corrector::tide;
using namespace std::chrono_literals;

namespace {

const tide::Station kTsukuba{Degrees(36.216), Degrees(140.123), Metres(532.0)};
const UtcTime kStart = parse_rfc3339("2017-07-01T00:00:00Z").value();

tide::Series series(const std::string& rows) {
    const test::TemporaryDirectory folder;
    return tide::Series::read(folder.write("tide.csv", "time,tide_mgal\n" + rows));
}

tide::Series sampled_tide(std::chrono::seconds step, std::chrono::hours length) {
    std::string rows;
    for (UtcTime time = kStart; time <= kStart + length; time += step)
        rows += to_rfc3339(time) + ',' + text::shortest(direct_tide(time, kTsukuba).value()) + '\n';
    return series(rows);
}

/// Returns the largest difference from the sampled model between two times.
double largest_error_mgal(const tide::Series& tide, UtcTime from, UtcTime to) {
    double largest = 0.0;
    for (UtcTime time = from; time <= to; time += 433s) {
        const auto value = tide.at(time);
        REQUIRE(value.has_value());
        largest = std::max(largest, std::abs((*value - direct_tide(time, kTsukuba)).value()));
    }
    return largest;
}

/// Returns a row of 10 x^3 mGal, x in days from kStart: a cubic, which four points determine.
std::string cubic_row(std::chrono::minutes after) {
    const double x = seconds_between(kStart, kStart + after) / 86400.0;
    return to_rfc3339(kStart + after) + ',' + text::shortest(10.0 * x * x * x) + '\n';
}

}  // namespace

TEST_CASE("a series reproduces its model within 2e-7 mGal at 10 min, within 2e-4 mGal at 1 h") {
    const auto month = 30 * 24h;
    const double inside = largest_error_mgal(sampled_tide(600s, month), kStart, kStart + month);
    const double hourly = largest_error_mgal(sampled_tide(3600s, month), kStart, kStart + month);
    CAPTURE(inside, hourly);
    CHECK(inside < 2e-7);
    CHECK(hourly < 2e-4);
}

TEST_CASE("interpolation of a cubic is exact with unequal steps and at both ends") {
    std::string rows;
    for (const auto minute : {0min, 10min, 25min, 30min, 75min, 100min}) rows += cubic_row(minute);
    const tide::Series tide = series(rows);
    for (const auto minute : {0min, 4min, 27min, 60min, 90min, 100min}) {
        const double x = static_cast<double>(minute.count()) / 1440.0;
        CHECK(tide.at(kStart + minute).value().value() == Approx(10.0 * x * x * x).margin(1e-15));
    }
}

TEST_CASE("there is no value outside the series or in a gap, but there is one beside a gap") {
    std::string rows;
    for (const auto minute : {0min, 30min, 60min, 90min, 151min, 180min, 210min, 240min})
        rows += cubic_row(minute);
    const tide::Series tide = series(rows);
    CHECK_FALSE(tide.at(kStart - 1s).has_value());
    CHECK_FALSE(tide.at(kStart + 240min + 1s).has_value());
    CHECK_FALSE(tide.at(kStart + 120min).has_value());
    CHECK(tide.at(kStart + 89min).has_value());
    CHECK(tide.at(kStart + 152min).has_value());
}

TEST_CASE("a bad series is refused with line, column and value") {
    const auto [rows, message] = GENERATE(table<std::string, std::string>({
        {"2017-07-01T00:00:00,0\n", "tide.csv:2: time = 2017-07-01T00:00:00: not an instant"},
        {"2017-07-01T00:10:00Z,0\n2017-07-01T00:00:00Z,0\n", "tide.csv:3: time = 2017-07-01T00:00"},
        {"2017-07-01T00:00:00Z,70.1\n", "tide.csv:2: tide_mgal = 70.1: out of range"},
        {"2017-07-01T00:00:00Z,\n", "tide_mgal = : not a number"},
        {"2017-07-01T00:00:00Z,0\n", "too few rows; allowed: 4 or more"},
    }));
    CAPTURE(rows);
    CHECK_THROWS_WITH(series(rows), ContainsSubstring(message));
    CHECK_THROWS_AS(series(rows), InputError);
}

TEST_CASE("a row that the series does not cover is refused by name") {
    const test::TemporaryDirectory folder;
    std::string csv = "time,tide_mgal\n";
    for (int hour = 0; hour < 4; ++hour)
        csv += to_rfc3339(made_up::kMorning + std::chrono::hours(hour)) + ",0.05\n";
    tide::Choice choice;
    REQUIRE(set_tide_source(choice, folder.write("t.csv", csv).string(), ""));
    auto rows = made_up::day();
    CHECK_THROWS_WITH(
        apply_tide(rows, {}, choice),
        ContainsSubstring("t.csv: time = 2020-05-01T03:") &&
            ContainsSubstring("allowed: 2020-05-01T00:00:00Z to 2020-05-01T03:00:00Z"));
    rows.resize(3);
    apply_tide(rows, {}, choice);
    CHECK(rows[2].tide.value() == Approx(0.05));
}

TEST_CASE("the tide of a row is that of its middle, the tide of a bin that of the bin") {
    const text::Site site{"A", Degrees(140.0), Degrees(36.0), Metres(10.0), MilliGal(979900.0)};
    SurveyRow row;
    row.site = "A";
    row.time = kStart;
    std::vector<SurveyRow> rows{row};
    DayRecord day{{TimeSeries<DegC>(kStart, Hertz(1.0), {}), {}}, {}};
    DayBin bin;
    bin.time = kStart + 6min;
    day.bins = {bin};
    apply_tide(rows, {site}, {}, &day);
    const tide::Station station{site.latitude, site.longitude, site.altitude};
    CHECK(rows[0].tide == direct_tide(kStart, station));
    CHECK(day.bins[0].tide == direct_tide(kStart + 6min, station));
    CHECK(rows[0].tide != day.bins[0].tide);
}

TEST_CASE("the settings name the tide's source, model, factors and sign") {
    nlohmann::ordered_json settings;
    tide::Choice choice;
    describe_tide(settings, choice);
    CHECK(
        settings.dump() ==
        R"({"tide":"direct","tide_model":"positions of Moon and Sun, degrees 2 and 3, along the )"
        R"(ellipsoid's normal","tide_sign":"effect on gravity: positive where gravity is larger; )"
        R"(subtracted","tide_system":"tide-free","permanent_tide":"removed, with the factor delta2","delta2":1.16,"delta3":1.07})");
    set_tide_system(choice, "zero", "--tide-system");
    describe_tide(settings, choice);
    CHECK(settings["tide_system"] == "zero");
    CHECK(settings["permanent_tide"] == "attraction removed, deformation kept");
    CHECK_THROWS_WITH(set_tide_system(choice, "free", "--tide-system"),
                      "--tide-system = free: unknown; allowed: tide-free, zero or mean");
    set_tide_system(choice, "tide-free", "--tide-system");
    choice.source = "given";
    CHECK_THROWS_WITH(set_tide_system(choice, "mean", "--tide-system"),
                      StartsWith("--tide-system = mean: the tide is given, and what it contains"));
    describe_tide(settings, choice);
    CHECK(settings["tide_system"] == "as given");
    CHECK(settings["tide_model"] == "column earth_tide_mgal");
    CHECK(settings["permanent_tide"] == "as in the given tide");
    CHECK(settings["delta2"].is_null());
    SurveyRow row;
    row.site = "No.5";
    row.given_tide_system = "mean";
    CHECK_THROWS_WITH(
        take_given_system(choice, {SurveyRow(), row}, "day.csv"),
        "day.csv: tide_system = 'mean' of No.5 (1), but '' in the first row; allowed: one system");
    take_given_system(choice, {row}, "day.csv");
    describe_tide(settings, choice);
    CHECK(settings["tide_system"] == "mean");
    CHECK(settings["permanent_tide"] == "not removed");
    CHECK_NOTHROW(set_tide_system(choice, "mean", "--tide-system"));
    CHECK_THROWS_WITH(
        set_tide_system(choice, "tide-free", "--tide-system"),
        "--tide-system = tide-free: the given tide has the tide_system mean; allowed: "
        "that one, or the tide direct or longman");
    row.given_tide_system = "free";
    CHECK_THROWS_WITH(take_given_system(choice, {row}, "day.csv"),
                      "day.csv: tide_system = free: unknown; allowed: tide-free, zero or mean");
    choice = {};
    choice.source = "none";
    describe_tide(settings, choice);
    CHECK(settings["permanent_tide"] == "not removed");
    CHECK_FALSE(set_tide_source(choice, "moon", ""));
    CHECK_THROWS_WITH(set_tide_option(choice, "moon"), ContainsSubstring("--tide = moon: neither"));
}

TEST_CASE("a given tide of another sign, time or place is named; another permanent tide is not") {
    const text::Site site{"A", Degrees(140.0), Degrees(36.0), Metres(10.0), MilliGal(979900.0)};
    const auto doubt = [&site](double factor, Nanoseconds shift, double added_mgal,
                               const std::string& source) {
        std::vector<SurveyRow> rows(1);  // of no site, left out
        for (int hour = 0; hour < 24; ++hour) {
            SurveyRow& row = rows.emplace_back();
            row.site = "A";
            row.occupation = hour + 1;
            row.time = kStart + std::chrono::hours(hour);
            const tide::Station station{site.latitude, site.longitude, site.altitude};
            row.tide =
                MilliGal(factor * direct_tide(row.time + shift, station).value() + added_mgal);
        }
        const auto warnings = tide_warnings(rows, {site}, {source, {}, {}});
        return warnings.empty() ? std::string() : warnings.at(0).english();
    };
    CHECK(doubt(1.2 / 1.16, 0s, 0.06, "given").empty());
    CHECK(doubt(0.0, 0s, 0.0, "none").empty());
    CHECK_THAT(
        doubt(0.0, 0s, 0.0, "given"),
        StartsWith("the tide given is 0 throughout, where the computed one varies by more than "
                   "0.03 mGal."));
    CHECK_THAT(doubt(-1.0, 0s, 0.0, "given"),
               StartsWith("the tide given is not that of these times and places: it differs from "
                          "the computed one by up to 0.") &&
                   EndsWith("; it fits with the other sign of the tide. It is used as it is"));
    CHECK_THAT(doubt(1.0, 9h, 0.0, "given"),
               ContainsSubstring("at A (15)") &&
                   EndsWith("; it fits if +9.0 h are added to the times. It is used as it is"));
    CHECK_THAT(doubt(2.0, 0s, 0.0, "given"),
               EndsWith(": check its sign, the times and the positions. It is used as it is"));
}

TEST_CASE("factors of a tide that is not computed are named, because they have no effect") {
    const auto count = [](const std::string& source, const Factors& factors) {
        return tide_warnings({}, {}, {source, factors, {}}).size();
    };
    CHECK(count("direct", {1.2, 1.07}) == 0);
    CHECK(count("given", {}) == 0);
    for (const std::string source : {"given", "none"})
        CHECK(tide_warnings({}, {}, {source, {1.2, 1.07}, {}}).at(0) ==
              "the tide is " + source +
                  ": delta2 and delta3 have an effect only on a computed one");
    CHECK(count("given", {1.16, 1.0}) == 1);
}

TEST_CASE("a tide that the survey declares as given must be in the table") {
    const std::vector<text::Site> sites{
        {"A", Degrees(140.0), Degrees(36.0), Metres(10.0), MilliGal(979900.0)}};
    SurveyRow row;
    row.site = "A";
    row.time = kStart;
    std::vector<SurveyRow> rows{row};
    CHECK_THROWS_WITH(apply_tide(rows, sites, {"given", {}, {}}),
                      ContainsSubstring("tide = given"));
    apply_tide(rows, sites, {"direct", kRigidEarth, {}});
    CHECK(rows[0].tide ==
          direct_tide(rows[0].time, {Degrees(36.0), Degrees(140.0), Metres(10.0)}, kRigidEarth));
}
