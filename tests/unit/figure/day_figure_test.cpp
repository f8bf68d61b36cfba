#include "corrector/figure/gnuplot_script.hpp"
#include "corrector/figure/survey_figures.hpp"
#include "tests/unit/figure/corrected_rows.hpp"
#include "tests/unit/model/survey_rows.hpp"

using namespace a351;
using namespace a351::corrector;
using namespace a351::corrector::figure;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;

TEST_CASE("the axis of the day names each stay once, and shows dates if there are several") {
    auto rows = made_up::day();
    rows[1].site = "B";
    rows[1].occupation = 1;
    std::string script = script_of(day_figure(corrected(rows), {}, {}, {}, {}));
    CHECK(count(script, "set label 'B' at first") == 3);  // three stays, the first of two set-ups
    CHECK_THAT(script,
               ContainsSubstring("set format x '%H:%M'") && ContainsSubstring("'UTC, 2020-05-01'"));
    rows.back().time += std::chrono::days(2);
    script = script_of(day_figure(corrected(rows), {}, {}, {}, {}));
    CHECK_THAT(script, ContainsSubstring("'%H:%M'.\"\\n\".'%m-%d'") &&
                           ContainsSubstring("'UTC, 2020-05-01 to 2020-05-03'"));
}

TEST_CASE("the day shows errors with their u only for readings with a reference") {
    auto rows = made_up::day();
    rows[1].reference.reset();
    const Figure figure = day_figure(corrected(rows), {}, {}, {}, {});
    CHECK(count(script_of(figure), "yerrorbars") == 1);
    const std::string errors = figure.data.substr(0, figure.data.find("\n\n\n"));
    CHECK(count(errors, "\n2020") == 11);
    CHECK_THAT(figure.caption, ContainsSubstring("in sample") &&
                                   ContainsSubstring("standard uncertainty u as of a new station"));
    SurveyCorrection unknown;
    for (const SurveyRow& row : rows) unknown.rows.emplace_back().row = row;
    CHECK(count(script_of(day_figure(unknown, {}, {}, {}, {})), "yerrorbars") == 0);
}

TEST_CASE("the day shows the whole-day model's errors with the station left out") {
    SurveyCorrection result = corrected(made_up::day());
    result.own = WholeDayPart{};
    for (CorrectedRow& row : result.rows)
        row.own.emplace<WholeDayRow>().left_out = *row.row.reference - MilliGal(7.77);
    const Figure figure = day_figure(result, {}, {}, {}, {});
    CHECK(count(figure.data, "Z -7.7700 ") == 12);
    CHECK_THAT(figure.caption, ContainsSubstring("left out, minus reference (cross-validated)"));
}

TEST_CASE("a stay without a value is on the axis of the day") {
    SurveyCorrection result = corrected(made_up::day());
    const UtcTime end = result.rows[0].row.time - std::chrono::minutes(5);
    add_left_out(result, {{"S9", 2, end - std::chrono::hours(1), end, "no samples"}});
    const std::string script = script_of(day_figure(result, {}, {}, {}, {}));
    CHECK_THAT(script, ContainsSubstring("'S9' at first '") &&
                           ContainsSubstring("from '" + to_rfc3339(end - std::chrono::hours(1)) +
                                             "',graph 0 to '" + to_rfc3339(end) + "'"));
}

TEST_CASE("the caption of the day lists the names that have no room") {
    SurveyCorrection result = corrected(made_up::day());
    CHECK_THAT(day_figure(result, {}, {}, {}, {}).caption, !ContainsSubstring("No room"));
    const UtcTime time = result.rows[0].row.time;
    std::vector<reading::LeftOut> crowd;
    for (int i = 0; i < 8; ++i)
        crowd.push_back({"far " + std::to_string(i), 1, time, time, "no samples"});
    add_left_out(result, crowd);
    const Figure figure = day_figure(result, {}, {}, {}, {});
    const std::string script = script_of(figure);
    int listed = 0;
    for (int i = 0; i < 8; ++i) {
        const std::string name = "far " + std::to_string(i);
        const bool is_listed = figure.caption.find(name) != std::string::npos;
        listed += is_listed ? 1 : 0;
        CHECK(is_listed == (count(script, "set label '" + name + "'") == 0));
    }
    CHECK(listed >= 2);  // six rows
}

TEST_CASE("the curve of the day's temperature is interrupted where nothing was recorded") {
    const SurveyCorrection result = corrected(made_up::day());
    std::vector<archive_series::MinuteTemperature> course;
    for (const int minute : {0, 1, 5})
        course.push_back({made_up::kMorning + std::chrono::minutes(minute), DegC(42.0 + minute)});
    CHECK_THAT(day_figure(result, {}, course, {}, {}).data,
               ContainsSubstring("00:01:00Z 43.0000 \n\n2020-05-01T00:05:00Z 47.0000 \n"));
    CHECK_THAT(day_figure(result, {}, {}, {}, {}).data, !ContainsSubstring("means of a minute"));
}

TEST_CASE("the signal of the day is a band with a key in words, if the log has them") {
    const SurveyCorrection result = corrected(made_up::day());
    const auto at = [](int minute) { return made_up::kMorning + std::chrono::minutes(minute); };
    const Figure figure = day_figure(
        result, {}, {},
        {{at(0), at(5), "keep_off"}, {at(5), at(9), "go"}, {at(9), at(10), "new word"}}, {});
    CHECK_THAT(script_of(figure), ContainsSubstring("title 'YOU CAN GO'") &&
                                      ContainsSubstring("title 'KEEP OFF'") &&
                                      !ContainsSubstring("LOOK") && !ContainsSubstring("new word"));
    CHECK_THAT(figure.data,
               ContainsSubstring("2020-05-01T00:00:00Z 0.71\n2020-05-01T00:05:00Z 0.71\n"));
    CHECK_THAT(figure.caption, ContainsSubstring("Band: signal"));
    CHECK_THAT(day_figure(result, {}, {}, {}, {}).caption, !ContainsSubstring("Band"));
}
