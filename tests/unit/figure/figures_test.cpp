#include <regex>

#include "corrector/figure/gnuplot_script.hpp"
#include "corrector/figure/survey_figures.hpp"
#include "tests/golden/tsukuba_table.hpp"
#include "tests/unit/figure/corrected_rows.hpp"
#include "tests/unit/model/survey_rows.hpp"

using namespace a351;
using namespace a351::corrector;
using namespace a351::corrector::figure;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;

namespace {

/// Returns a record of ten minutes at 2 s with a knock, averaged from its third sample on.
RepresentativeValue record_at(UtcTime start) {
    std::vector<double> series, curve, temperature;
    for (int i = 0; i < 300; ++i) {
        series.push_back(i < 2 ? std::nan("") : 981700.0 + (i == 100 ? 500.0 : i % 2));
        temperature.push_back(42.5 + 1e-4 * i);
        if (i >= 2) curve.push_back(981700.5 + std::sin(0.03 * i));
    }
    const Hertz rate(0.5);
    RecordSummary summary;
    summary.curve_mean = MilliGal(981700.5);
    return {summary,
            {},
            start + std::chrono::seconds(4),
            start + std::chrono::seconds(598),
            {},
            {start, rate, series},
            {start + std::chrono::seconds(4), rate, curve},
            {start, rate, temperature}};
}

SurveyRow row_behind(const RepresentativeValue& value, const std::string& site) {
    SurveyRow row;
    row.site = site;
    row.start = value.interval_start;
    row.end = value.interval_end;
    row.time = value.interval_start;
    return row;
}

text::Site site(const std::string& name, double longitude, double latitude, bool is_known = true) {
    text::Site site{name, Degrees(longitude), Degrees(latitude), Metres(100.0), {}};
    if (is_known) site.gravity = MilliGal(979800.0);
    return site;
}

SurveyCorrection with_stations(const std::vector<std::string>& names) {
    SurveyCorrection result;
    for (const std::string& name : names) result.stations.emplace_back().site = name;
    return result;
}

/// Returns the range of an axis.
std::pair<double, double> range(const std::string& script, const std::string& axis) {
    std::smatch limits;
    REQUIRE(std::regex_search(script, limits, std::regex(axis + "range \\[(.*):(.*)\\]")));
    return {std::stod(limits[1]), std::stod(limits[2])};
}

}  // namespace

TEST_CASE("figures 12 and 13 of the publication are reproduced with the lines printed there") {
    const SurveyCorrection result = corrected(tsukuba::observations());
    // Lines in the publication: 0.97348 x + 27825, R2 0.9748; -29.27 x + 3085, R2 0.926.  At the means of x,
    // 979892.35 and 42.67, these are 981730.6 and 1836.0.
    CHECK_THAT(script_of(acceleration_figure(result, {}).value()),
               ContainsSubstring("'slope 0.9735, R² = 0.9748'") &&
                   ContainsSubstring("left out of the fit"));
    CHECK_THAT(script_of(difference_figure(result, {}).value()),
               ContainsSubstring("'slope -29.2309, R² = 0.9257'"));
}

TEST_CASE("an axis of six digits counts from a whole thousand, and so do the data") {
    const auto figure = acceleration_figure(corrected(tsukuba::observations()), {});
    const std::string script = script_of(figure.value());
    CHECK_THAT(script, ContainsSubstring("'Reference gravity \u2212 979000 (mGal)'") &&
                           ContainsSubstring("'Acceleration \u2212 981000 (mGal)'"));
    CHECK_THAT(figure->data, ContainsSubstring("\n860.2100 "));
}

TEST_CASE("a figure of small numbers keeps them") {
    CHECK_THAT(script_of(difference_figure(corrected(tsukuba::observations()), {}).value()),
               ContainsSubstring("'Temperature (°C)'"));
}

TEST_CASE("corrected gravity over reference has u as bars and the publication's number") {
    const Figure figure = corrected_figure(corrected(made_up::day()), {}).value();
    CHECK(count(script_of(figure), "yerrorbars") == 1);
    CHECK_THAT(figure.caption, EndsWith(" (Publication's Fig. 14.)"));
    CHECK_THAT(as_published("3", "0.265"), EndsWith("Fig. 3; value there: 0.265.)"));
    // A table of averages does not know the scatter of the samples.
    CHECK(count(script_of(difference_figure(corrected(made_up::day()), {}).value()),
                "yerrorbars") == 0);
}

TEST_CASE("every row is in a block of its kind, and an empty block is not plotted") {
    auto rows = made_up::day();
    rows[1].reference.reset();
    rows[2].is_flagged = true;
    const Figure figure = acceleration_figure(corrected(rows), {}).value();
    CHECK(count(figure.data, "\n\n\n") == 2);  // Two kinds and the line.
    CHECK(count(figure.data, "# B (") == 3);
    CHECK(count(figure.data, "# S1 (1)") == 0);
    CHECK(figure.data.find("# S2 (1)") > figure.data.find("# left out of the fit"));
    for (SurveyRow& row : rows) row.reference.reset();
    SurveyCorrection unknown;
    for (const SurveyRow& row : rows) unknown.rows.emplace_back().row = row;
    CHECK_FALSE(acceleration_figure(unknown, {}).has_value());
}

TEST_CASE(
    "half the difference and half the sum of both faces are drawn for the stays that have both") {
    auto rows = made_up::day();
    CHECK_FALSE(faces_figure(corrected(rows), {}));
    SurveyCorrection result = corrected(rows);
    for (std::size_t k : {0U, 1U}) {
        CorrectedRow down = result.rows[k];
        down.row.face = -1;
        down.row.time += std::chrono::minutes(4);
        // The bias has the other sign, and the scale adds 0.4 mGal in both faces.
        const MilliGal gravity = result.stations[k].gravity;
        const double bias_mgal = 1800.0 + static_cast<double>(k);
        result.rows[k].row.acceleration = gravity + down.row.tide + MilliGal(bias_mgal + 0.4);
        down.row.acceleration = gravity + down.row.tide - MilliGal(bias_mgal - 0.4);
        result.rows.push_back(down);
    }
    const Figure figure = faces_figure(result, {}).value();
    REQUIRE(figure.panels.size() == 2);
    CHECK(figure.block_count == 2);
    CHECK(figure.data.find("2020-05-01T00:02:00Z -0.5000 # B") != std::string::npos);
    CHECK(figure.data.find("Z 0.5000 # S1") != std::string::npos);
    CHECK(count(figure.data, " 0.4000 # ") == 2);
    CHECK_THAT(figure.caption, ContainsSubstring("the day's mean of 1800.5 mGal"));
    // Readings that are not corrected differ by twice the bias.
    CHECK_FALSE(difference_figure(result, {}));
    CHECK_FALSE(acceleration_figure(result, {}));
    CHECK(corrected_figure(result, {}));
}

TEST_CASE("a record belongs to the row with the same interval") {
    const UtcTime morning = made_up::kMorning;
    const std::vector<RepresentativeValue> values{record_at(morning),
                                                  record_at(morning + std::chrono::hours(1))};
    SurveyCorrection result;
    result.rows.resize(2);
    result.rows[0].row = row_behind(values[1], "B");
    result.rows[1].row = row_behind(values[1], "C");
    result.rows[1].row.end = morning;
    const auto records = find_records(result, values);
    REQUIRE(records.size() == 1);
    CHECK(records.front().row == 0);
    CHECK(records.front().value == &values[1]);
}

TEST_CASE("a row of the whole-day model gets the record of which it averages more") {
    const std::vector<RepresentativeValue> values{
        record_at(made_up::kMorning), record_at(made_up::kMorning + std::chrono::hours(1))};
    SurveyCorrection result;
    result.own = WholeDayPart{};
    result.rows.resize(1);
    SurveyRow& row = result.rows[0].row;
    row = row_behind(values[1], "B");
    row.start = made_up::kMorning + std::chrono::hours(1);
    row.end = *row.start + std::chrono::minutes(5);
    row.acceleration = MilliGal(981702.125);
    result.rows[0].own.emplace<WholeDayRow>().averaged_s = 280.0;
    const auto records = find_records(result, values);
    REQUIRE(records.size() == 1);
    CHECK(records.front().value == &values[1]);
    CHECK_THAT(reading_figures(result, records, {}).at(0).caption,
               ContainsSubstring("the model day averages 280 s of it, mean 981702.125 mGal"));
    CHECK_THAT(script_of(panel_figures(result, records, {}).at(0)),
               ContainsSubstring("'981702.1'"));
}

TEST_CASE("the figure of a reading has its series, trend, extrema and interval") {
    const std::vector<RepresentativeValue> values{record_at(made_up::kMorning)};
    SurveyCorrection result;
    result.rows.resize(1);
    result.rows[0].row = row_behind(values[0], "O'Hara <3");
    result.rows[0].row.acceleration = MilliGal(981700.5);
    result.rows[0].row.temperature = DegC(42.5);
    const auto records = find_records(result, values);
    const Figure figure = reading_figures(result, records, {}).at(0);
    CHECK(figure.name == "reading-01");
    CHECK_THAT(script_of(figure),
               ContainsSubstring("set label 'O\u2019Hara <3 (1), 9.9 of 10.0 min' at screen"));
    // The minutes that the reading uses are shaded.
    CHECK_THAT(script_of(figure), ContainsSubstring("rectangle from 0.06666666667,graph 0 to "
                                                    "9.966666667,graph 1 fc rgb '#cfe6f4'"));
    // The knock of 500 mGal does not stretch the axis.
    CHECK_THAT(script_of(figure), ContainsSubstring("set yrange [-1.09999"));
    CHECK_THAT(figure.data, StartsWith("# minus 981700.500 mGal and 42.50000 degC: minutes "
                                       "acceleration_mgal trend_mgal temperature_degc time_utc\n"
                                       "0.0000 NaN NaN 0.00000 2020-05-01T00:00:00.000Z\n"));
    CHECK_THAT(figure.data, ContainsSubstring("\n0.0667 -0.500 0.060 0.00020 2020-"));
    // sin(0.03 i) has its extrema at i = 52.4, 157.1 and 261.8.
    CHECK_THAT(figure.data,
               ContainsSubstring("trend_mgal\n1.7333 1.000 \n5.2333 -1.000 \n8.7333 "));
    CHECK_THAT(figure.data, ContainsSubstring("interval: minutes trend_mgal\n0.0667 0.060 \n"
                                              "9.9667 "));

    const auto panels = panel_figures(result, records, {});
    REQUIRE(panels.size() == 2);
    CHECK_THAT(script_of(panels[0]),
               ContainsSubstring("plot 'reading-01.dat' index 0 using 1:2 with"));
    CHECK_THAT(script_of(panels[1]),
               ContainsSubstring("plot 'reading-01.dat' index 0 using 1:4 with"));
    CHECK(panels[0].data.empty());
}

TEST_CASE(
    "on the map a degree of longitude is shorter than one of latitude by the cosine of the "
    "latitude") {
    SurveyCorrection result = with_stations({"A", "B", "C"});
    const auto figure = map_figure(result,
                                   {site("A", 10.0, 60.0), site("B", 10.2, 60.01),
                                    site("elsewhere", 50.0, 0.0), site("C", 10.1, 59.99, false)},
                                   {});
    const std::string script = script_of(figure.value());
    const auto [west, east] = range(script, "x");
    const auto [south, north] = range(script, "y");
    // The plot is 53.5 by 70 mm.
    CHECK((east - west) / 53.5 * 0.5 == Approx((north - south) / 70).epsilon(1e-5));
    CHECK(west < 10.0);
    CHECK(east > 10.2);
    CHECK_THAT(script,
               ContainsSubstring("unknown gravity") && ContainsSubstring("set label '2 km'"));
    CHECK(count(figure.value().data, "elsewhere") == 0);
    CHECK_FALSE(map_figure(result, {}, {}).has_value());
}

TEST_CASE("the map of stations across the 180th meridian is one piece") {
    // After GNS-Science/gsolve and obspy's events_longitude_wrap.
    SurveyCorrection result = with_stations({"A", "B", "C"});
    const double second = GENERATE(-179.99, 180.01);
    const std::string script = script_of(
        map_figure(result,
                   {site("A", 179.99, 36.2), site("B", second, 36.21), site("C", 180, 36.2)}, {})
            .value());
    CHECK(range(script, "x").first > 179.9);
    CHECK(range(script, "x").second < 180.1);
    CHECK_THAT(script, ContainsSubstring("set label '500 m'"));
}

TEST_CASE("the map shows gravity and the order of the visits, those without a value too") {
    SurveyCorrection result = corrected(made_up::day());
    const UtcTime start = result.rows[0].row.time + std::chrono::minutes(5);
    add_left_out(result, {{"S5", 7, start, start, "no samples"}});
    const Figure figure =
        map_figure(result, {site("B", 10.0, 60.0), site("S5", 10.2, 60.01)}, {}).value();
    // B is read first, fifth and last of 12; the stay without a value is the second.
    CHECK_THAT(script_of(figure), ContainsSubstring("'B [1, 6, 13]'") &&
                                      ContainsSubstring("'S5 [2, ") &&
                                      ContainsSubstring(" palette "));
    CHECK_THAT(figure.data, ContainsSubstring("10.000000 60.000000 1\n10.200000 60.010000 2\n"));
}

TEST_CASE("stations that are all at one place still give a map") {
    SurveyCorrection result = with_stations({"A", "B"});
    const Figure figure =
        map_figure(result, {site("A", 10.0, 45.0), site("B", 10.0, 45.0)}, {}).value();
    CHECK_THAT(script_of(figure), ContainsSubstring("set label 'A'") &&
                                      ContainsSubstring("set label 'B'") &&
                                      ContainsSubstring("set label '20 m'"));
}

TEST_CASE("the labels of the map cover neither a point nor another label") {
    SurveyCorrection result = with_stations({"A", "B", "C", "D"});
    // B is a little east of A, so that A's label must be left of it; the others are far away.
    const Figure figure = map_figure(result,
                                     {site("A", 10.0, 45.0), site("B", 10.004, 45.0),
                                      site("C", 10.1, 45.05), site("D", 9.9, 44.95)},
                                     {})
                              .value();
    const std::vector<Text>& texts = figure.panels.front().texts;
    CHECK(texts.at(0).side == "right");
    CHECK(texts.at(1).side == "left");
    const Figure same =
        map_figure(result, {site("A", 10.0, 45.0), site("B", 10.0, 45.0), site("C", 10.0, 45.0)},
                   {})
            .value();
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < i; ++k) {
            const Text &one = same.panels.front().texts.at(i),
                       &other = same.panels.front().texts.at(k);
            const double apart_mm = std::abs(one.place.y - other.place.y) * 70;
            CHECK((one.side != other.side || apart_mm > 2.99));
        }
}

TEST_CASE("the map names the stations whose label has no room, and no pointer crosses a label") {
    SurveyCorrection result;
    std::vector<text::Site> sites;
    for (int i = 0; i < 40; ++i) {
        sites.push_back(site("Station " + std::to_string(i), 10.0, 45.0));
        result.stations.emplace_back().site = sites.back().name;
    }
    const Figure crowded = map_figure(result, sites, {}).value();
    const std::size_t shown = crowded.panels.front().texts.size() - 1;  // that of the scale
    CHECK(shown < 40);
    for (std::size_t i = 0; i < 40; ++i) {
        const bool is_shown =
            std::ranges::any_of(crowded.panels.front().texts,
                                [&](const Text& one) { return one.text == sites[i].name; });
        const std::string list =
            crowded.caption.substr(crowded.caption.find("No room for the names of:"));
        CHECK(is_shown != ((list + ',').find(sites[i].name + ',') != std::string::npos ||
                           list.find(sites[i].name + '.') != std::string::npos));
    }
    sites.resize(2);
    result.stations.resize(2);
    CHECK_THAT(map_figure(result, sites, {})->caption, !ContainsSubstring("No room"));
}

TEST_CASE("a station without coordinates is not on the map") {
    SurveyCorrection result = with_stations({"A", "B"});
    std::vector<text::Site> sites{site("A", 10.0, 45.0), site("B", 10.0, 45.0)};
    sites[1].is_placed = false;
    const auto figure = map_figure(result, sites, {});
    CHECK_THAT(script_of(figure.value()),
               ContainsSubstring("set label 'A'") && !ContainsSubstring("set label 'B'"));
    CHECK_THAT(figure.value().caption, EndsWith("Not shown, because they have no position: B."));
    sites[0].is_placed = false;
    CHECK_FALSE(map_figure(result, sites, {}));
}

TEST_CASE("the steps of an axis are round numbers") {
    CHECK(round_step(0.73) == Approx(0.5));
    CHECK(round_step(2.0) == Approx(2.0));
    CHECK(round_step(4.9) == Approx(2.0));
    CHECK(round_step(999.0) == Approx(500.0));
    CHECK(round_step(0.0015) == Approx(0.001));
}

TEST_CASE("the noise of a day is that of the readings in the fit, beside the data sheet's") {
    SurveyCorrection result = corrected(tsukuba::observations());
    const RepresentativeValue value = record_at(result.rows[0].row.time);
    const std::vector<ReadingRecord> records{{0, &value}, {1, &value}};
    const auto density = [&] { return quiet_noise_figures(result, records, 0.37, {}).front(); };
    const Figure both = density();
    CHECK_THAT(script_of(both), ContainsSubstring("data sheet"));
    CHECK_THAT(both.data, ContainsSubstring("0.370000"));
    result.rows[1].is_used = false;
    CHECK(density().caption != both.caption);  // fewer minutes
    result.rows[0].is_used = false;
    CHECK(quiet_noise_figures(result, records, 0.37, {}).empty());
}
