#include "corrector/report/result_tables.hpp"

#include <pugixml.hpp>
#include <regex>

#include "corrector/model/survey_correction.hpp"
#include "tests/unit/model/survey_rows.hpp"
#include "tests/unit/whole_day/made_up_day.hpp"

using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;
using namespace a351::corrector::report;
using namespace a351::corrector::whole_day;

namespace {

using Lines = std::vector<std::map<std::string, std::string>>;

/// Returns the cells of each line of the first table by the title of their column.
Lines lines_of(const pugi::xml_node& page) {
    const auto table = page.select_node("//table").node();
    std::vector<std::string> titles;
    for (const auto& cell : table.select_nodes("thead//th"))
        titles.emplace_back(cell.node().child_value());
    Lines lines;
    for (const auto& row : table.select_nodes("tbody/tr")) {
        auto title = titles.begin();
        auto& line = lines.emplace_back();
        for (const auto& cell : row.node().children("td")) line[*title++] = cell.child_value();
        CHECK(title == titles.end());
    }
    return lines;
}

Lines readings_of(const SurveyCorrection& result) {
    pugi::xml_document document;
    add_readings(document.append_child("body"), result);
    return lines_of(document);
}

SurveyCorrection corrected_by_day(const DayRecord& day) {
    std::vector<SurveyRow> rows;
    for (std::size_t s = 0; s < MadeUpDay::kSetUps; ++s) {
        SurveyRow& row = rows.emplace_back();
        row.site = "S" + std::to_string(s % 11);
        row.occupation = s < 11 ? 1 : 2;
        row.time = day.bins[s * MadeUpDay::kBins + 3].time;
        row.start = row.time - std::chrono::minutes(1);  // the trend's interval
        row.end = row.time + std::chrono::minutes(1);
        row.reference = MilliGal(MadeUpDay::gravity_mgal(s));
    }
    return correct_survey(rows, {.model = "day"}, &day);
}

}  // namespace

TEST_CASE(
    "the corrections of the whole-day model add up to the corrected value, with the constant") {
    pugi::xml_document document;
    add_corrections(document.append_child("body"), corrected_by_day(kScattered.record()));
    const std::string caption = document.select_node("//figcaption").node().child_value();
    std::smatch constant;
    REQUIRE(std::regex_search(caption, constant, std::regex("constant of (-?[0-9.]+) ")));
    const Lines lines = lines_of(document);
    REQUIRE(lines.size() == MadeUpDay::kSetUps);
    double mean = 0.0;
    for (auto line : lines) {
        const auto value = [&line](const char* title) { return std::stod(line.at(title)); };
        const double sum = value("Acceleration") - value("Tide") + std::stod(constant[1]) +
                           value("T corr.") + value("Rate corr.") + value("Drift corr.") +
                           value("Scale corr.") + value("Tilt corr.") + value("Flicker corr.");
        CHECK(sum == Approx(value("Corrected")).epsilon(0).margin(0.045));  // nine roundings
        mean += value("T corr.") / static_cast<double>(lines.size());
    }
    CHECK(mean == Approx(0.0).margin(0.01));
}

TEST_CASE("t of the whole-day model is the error with the station left out over its u") {
    for (auto line : readings_of(corrected_by_day(kScattered.record()))) {
        const auto value = [&line](const char* title) { return std::stod(line.at(title)); };
        // All but t are rounded to 0.1.
        CHECK((value("Left out") - value("Reference")) / value("u") ==
              Approx(value("t")).epsilon(0.05).margin(0.1));
    }
}

TEST_CASE("the table of the whole-day model shows which time it averages") {
    DayRecord day = kScattered.record();
    std::erase_if(day.bins, [](const DayBin& bin) {
        return bin.set_up == 2 && bin.time < MadeUpDay::start() + std::chrono::minutes(183);
    });
    const auto lines = readings_of(corrected_by_day(day));
    // 14 bins of 25 samples, 2 s apart, from 02:00 on every half hour.
    CHECK(lines[0].at("Averaged UTC") == "2026-05-01 02:00:00\u201302:11:38");
    CHECK(lines[0].at("Min used") == "11.7");
    CHECK(lines[2].at("Averaged UTC") == "2026-05-01 03:03:20\u201303:11:38");
    CHECK(lines[2].at("Min used") == "8.3");
}

TEST_CASE("a table of given averages has no columns of records") {
    const auto lines = readings_of(correct_survey(made_up::day(), {.model = "t"}));
    REQUIRE(lines.size() == 12);
    for (const char* const title : {"Averaged UTC", "Min used", "Left out"})
        CHECK_FALSE(lines[0].contains(title));
}

TEST_CASE("an occupation without a value is listed in time order") {
    SurveyCorrection result = correct_survey(made_up::day(), {.model = "t"});
    const UtcTime start = result.rows[2].row.time - std::chrono::minutes(9);
    add_left_out(result, {{"S9", 2, start, start, "no samples"}});
    const auto lines = readings_of(result);
    REQUIRE(lines.size() == 13);
    CHECK(lines[2].at("Reading") == "S9 (2)");
    CHECK(lines[2].at("Time UTC") == to_rfc3339(start));
    CHECK(lines[2].at("Corrected") == "-");
    CHECK(lines[2].at("Flags") == "no samples");
}
