#include <filesystem>
#include "tests/support/catch.hpp"

#include "corrector/reading/survey_row.hpp"
#include "protocol/core/input_error.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::corrector::reading;

namespace {

const std::vector<text::Site> kObservedSites{
    {"A", Degrees(140.0), Degrees(36.0), Metres(10.0), MilliGal(979900.0)},
    {"B", Degrees(140.1), Degrees(36.1), Metres(20.0), std::nullopt}};

/// A table of observations on disk.
class TableFile {
public:
    explicit TableFile(const std::string& content)
        : path_(folder_.write("observations.csv", content)) {}

    [[nodiscard]] std::vector<SurveyRow> read() const {
        return read_observations(path_, kObservedSites);
    }

private:
    test::TemporaryDirectory folder_;
    std::filesystem::path path_;
};

const std::string kTableHeader =
    "site,occupation,outlier,time_utc,earth_tide_mgal,acceleration_mgal,temperature_degc\n";

}  // namespace

TEST_CASE("rows are read with all their columns and sorted by time") {
    const auto rows = TableFile(kTableHeader +
                                "B,1,1,2020-01-01T02:00:00Z,-0.02,981700.5,42.7\n"
                                "A,1,0,2020-01-01T00:00:00,0.01,981700.25,42.5\n")
                          .read();
    REQUIRE(rows.size() == 2);
    CHECK(rows[0].site == "A");
    CHECK(rows[0].reference == MilliGal(979900.0));
    CHECK(rows[0].given_tide == MilliGal(0.01));
    CHECK(rows[0].acceleration == MilliGal(981700.25));
    CHECK(rows[0].rate_degc_per_h == 0.0);
    CHECK(rows[1].is_flagged);
    CHECK_FALSE(rows[1].reference.has_value());
    CHECK(rows[1].rate_degc_per_h == Approx(0.1));
}

TEST_CASE("a local time column, a zone in the cell and UTC give the same time") {
    const UtcTime expected = parse_rfc3339("2019-12-31T23:42:12Z").value();
    const auto [column, cell] = GENERATE(table<std::string, std::string>({
        {"time_utc", "2019-12-31T23:42:12"},
        {"time_utc", "2019-12-31T23:42:12Z"},
        {"time_jst", "2020-01-01T08:42:12"},
        {"time_jst", "2019-12-31T23:42:12Z"},
        {"time", "2020-01-01T08:42:12+09:00"},
    }));
    CAPTURE(column, cell);
    const auto rows =
        TableFile("site,occupation," + column + ",acceleration_mgal,temperature_degc\nA,1," + cell +
                  ",981700,42.5\n")
            .read();
    CHECK(rows.front().time == expected);
    CHECK_FALSE(rows.front().is_flagged);
    CHECK_FALSE(rows.front().given_tide.has_value());
}

TEST_CASE("a bad table of observations is refused with line, column and value") {
    const std::string good = "A,1,0,2020-01-01T00:00:00Z,0.01,981700,42.5\n";
    const auto [content, message] = GENERATE_COPY(table<std::string, std::string>({
        {kTableHeader + "C,1,0,2020-01-01T00:00:00Z,0.01,981700,42.5\n", ":2: site = C: unknown"},
        {kTableHeader + "A,1.5,0,2020-01-01T00:00:00Z,0.01,981700,42.5\n", "occupation = 1.5"},
        {kTableHeader + "A,1,2,2020-01-01T00:00:00Z,0.01,981700,42.5\n", "outlier = 2"},
        {kTableHeader + "A,1,0,yesterday,0.01,981700,42.5\n", "time_utc = yesterday"},
        {kTableHeader + "A,1,0,2020-01-01T00:00:00Z,0.01,nan,42.5\n", "acceleration_mgal = nan"},
        {kTableHeader + "A,1,0,2020-01-01T00:00:00Z,0.01,981700,inf\n", "temperature_degc = inf"},
        {kTableHeader + "A,1,0,2020-01-01T00:00:00Z,0.01,1.001,42.5\n",
         "acceleration_mgal = 1.001"},
        {kTableHeader + "A,1,0,2020-01-01T00:00:00Z,70.0,981700,42.5\n", "earth_tide_mgal = 70.0"},
        {kTableHeader + good + good, ":3: time_utc = 2020-01-01T00:00:00Z: appears twice"},
        {kTableHeader, "no rows"},
        {"site,occupation,acceleration_mgal,temperature_degc\nA,1,981700,42.5\n",
         "no column of time"},
        {"site,occupation,time_utc,time_jst,acceleration_mgal,temperature_degc\n",
         "columns time_utc and time_jst"},
        {"site,occupation,time,acceleration_mgal,temperature_degc\n"
         "A,1,2020-01-01T00:00:00,981700,42.5\n",
         "time = 2020-01-01T00:00:00: not an instant"},
        {"site,occupation,time_utc,acceleration_mgal\nA,1,2020-01-01T00:00:00Z,981700\n",
         "column temperature_degc is missing"},
    }));
    CAPTURE(content);
    const TableFile file(content);
    CHECK_THROWS_WITH(file.read(), ContainsSubstring(message));
    CHECK_THROWS_AS(file.read(), InputError);
}

TEST_CASE(
    "a row far from all others in time is named, rows of a series of single readings are not") {
    const auto warnings = [](const std::string& second, const std::string& last) {
        std::string rows = kTableHeader;
        for (const std::string& time : {std::string("2020-03-01T00:00:00Z"), second,
                                        std::string("2020-03-01T02:00:00Z"), last})
            rows += "A,1,0," + time + ",0,981700,42.5\n";
        return row_warnings(TableFile(rows).read());
    };
    CHECK(warnings("2020-03-01T01:00:00Z", "2020-03-21T02:00:00Z").empty());
    const auto of_year = warnings("2010-03-01T01:00:00Z", "2020-03-01T03:00:00Z");
    REQUIRE(of_year.size() == 1);
    CHECK(of_year[0].english() ==
          "A (1): 2010-03-01T01:00:00Z is 3653 days from every other reading: check its year and "
          "month");
    CHECK(warnings("2020-03-01T01:00:00Z", "2020-03-22T02:00:00Z").size() == 1);
    CHECK(warnings("1690-03-01T01:00:00Z", "2020-03-01T03:00:00Z").size() == 1);
    CHECK(warnings("2010-03-01T01:00:00Z", "2020-04-01T02:00:00Z").empty());
}

TEST_CASE("a temperature far from the others and an earlier stay with a later number are named") {
    const auto warnings = [](const std::string& numbers, const std::string& degc,
                             const std::string& last_hour = "03",
                             const std::string& third_hour = "02") {
        const std::vector<std::string> hours{"00", "01", third_hour, last_hour};
        std::string rows = kTableHeader;
        for (std::size_t i = 0; i < 4; ++i)
            rows += fmt::format("A,{},0,2020-03-01T{}:00:00Z,0,981700,{}\n", numbers[i], hours[i],
                                i == 2 ? degc : "42.5");
        return text::in_english(row_warnings(TableFile(rows).read()));
    };
    CHECK(warnings("1234", "52.5").empty());
    CHECK(
        warnings("1234", "0") ==
        std::vector<std::string>{
            "A (3): its temperature of 0.00 degC is far from the median of 42.50 degC: check it"});
    CHECK(warnings("2345", "42.5", "10").empty());
    CHECK(warnings("1432", "42.5").size() == 1);
    CHECK(warnings("2341", "42.5") ==
          std::vector<std::string>{"A (1), 2020-03-01T03:00:00Z, is later than A (4), "
                                   "2020-03-01T02:00:00Z: check hours and zone of both"});
    CHECK(warnings("4111", "42.5", "10").size() == 1);
    CHECK(warnings("1121", "42.5", "10").empty());  // 8 h after the second stay
    CHECK(warnings("1234", "42.5", "12", "23") ==
          std::vector<std::string>{"A (4), 2020-03-01T12:00:00Z, is earlier than A (3), "
                                   "2020-03-01T23:00:00Z, but below it in the table: check hours "
                                   "and zone of both"});
    // A table grouped by site is in another order.
    CHECK(text::in_english(
              row_warnings(TableFile(kTableHeader + "A,1,0,2020-03-01T00:00:00Z,0,981700,42.5\n"
                                                    "A,2,0,2020-03-01T05:00:00Z,0,981700,42.5\n"
                                                    "B,1,0,2020-03-01T01:00:00Z,0,981700,42.5\n"
                                                    "B,2,0,2020-03-01T04:00:00Z,0,981700,42.5\n")
                               .read()))
              .empty());
    std::vector<SurveyRow> backwards(3);
    for (std::size_t i = 0; i < 3; ++i) {
        backwards[i].time = UtcTime(std::chrono::hours(i));
        backwards[i].table_row = 2 - i;
    }
    CHECK(row_warnings(backwards).empty());  // The table is not sorted.
}

TEST_CASE("a reference that is known to more than 1 mGal is named") {
    SurveyRow row;
    row.site = "A";
    row.u_reference = MilliGal(1.0);
    CHECK(row_warnings({row, row}).empty());
    row.u_reference = MilliGal(10.6);
    const auto warnings = row_warnings({row, row});
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].english() ==
          "A: gravity is known to 10.6 mGal only; or is u_gravity_mgal in microgals?");
}

TEST_CASE("the scatter of an average is that of its readings divided by the root of their number") {
    const std::string line = "A,1,2020-01-01T00:00:00Z,979800,42.5,";
    const std::string header = "site,occupation,time_utc,acceleration_mgal,temperature_degc,";
    CHECK(TableFile(header + "sd_mgal\n" + line + "0.3\n").read()[0].u_average == MilliGal(0.3));
    CHECK(TableFile(header + "sd_mgal,readings\n" + line + "0.3,9\n").read()[0].u_average.value() ==
          Approx(0.1));
    CHECK(TableFile(header + "sd_mgal\n" + line + "\n").read()[0].u_average == MilliGal(0.0));
    CHECK_THROWS_AS(TableFile(header + "sd_mgal\n" + line + "-1\n").read(), InputError);
    CHECK_THROWS_AS(TableFile(header + "sd_mgal,readings\n" + line + "0.3,0\n").read(), InputError);
}

TEST_CASE(
    "rows of gravimeters have instrument and loop, and need neither a full value nor a "
    "temperature") {
    const std::string header =
        "site,occupation,time_utc,acceleration_mgal,temperature_degc,instrument,loop\n";
    const auto rows = TableFile(header +
                                "A,1,2020-01-01T00:00:00Z,-12.5,,B44,1\n"
                                "A,2,2020-01-01T00:00:00Z,2700.25,,B108,3\n")
                          .read();
    REQUIRE(rows.size() == 2);
    CHECK(rows[0].acceleration == MilliGal(-12.5));
    CHECK(rows[0].instrument == "B44");
    CHECK(rows[1].loop == 3);
    CHECK_FALSE(rows[1].has_temperature);
    for (const std::string refused :
         {"A,1,2020-01-01T00:00:00Z,-30000,,B44,1\n", "A,1,2020-01-01T00:00:00Z,2700,,,1\n",
          "A,1,2020-01-01T00:00:00Z,2700,,B44,-1\n",
          "A,1,2020-01-01T00:00:00Z,2700,,B44,1\n"
          "B,1,2020-01-01T00:00:00Z,2700,,B44,1\n",
          "A,1,2020-01-01T00:00:00Z,2700,,B44,1\n"
          "B,1,2020-01-01T01:00:00Z,2700,40,B44,1\n"}) {
        INFO(refused);
        CHECK_THROWS_AS(TableFile(header + refused).read(), InputError);
    }
}
