#include "corrector/result/answer.hpp"

#include <sstream>

#include "corrector/model/survey_correction.hpp"
#include "corrector/result/table_text.hpp"
#include "protocol/text/aligned_text.hpp"
#include "tests/unit/model/survey_rows.hpp"

using namespace a351;
using namespace a351::corrector::judgement;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;
using namespace a351::corrector::result;

namespace {

/// Returns good readings with some scatter.
SurveyCorrection scattered_day() {
    return correct_survey(made_up::day_with_errors({0.5, -0.5}), {.model = "t-rate-drift"});
}

std::vector<ReadingGrade> all_good(const SurveyCorrection& result) {
    return std::vector<ReadingGrade>(result.rows.size());
}

}  // namespace

TEST_CASE("a value has one digit more than the first of its uncertainty") {
    CHECK(text::decimals_for(1.5) == 1);
    CHECK(text::decimals_for(0.94) == 2);
    CHECK(text::decimals_for(10.0) == 0);
    CHECK(text::decimals_for(310.0) == 0);
    CHECK(text::decimals_for(0.0) == 1);
    CHECK(text::decimals_for(std::nullopt) == 1);
}

TEST_CASE(
    "the answer gives the error of a station left out, and says so if nothing is to be repeated") {
    SurveyCorrection result = scattered_day();
    for (StationValue& station : result.stations) {
        station.left_out =
            *station.reference + MilliGal(&station == &result.stations[0] ? 4.75 : 0.0);
        station.u_gravity = MilliGal(1.5);
    }
    result.score.loso_mgal = 9.9;  // That of single rows.
    CHECK(answer(result, all_good(result)) ==
          "8 stations; a new one is known to +- 1.7 mGal (each known station left out). Nothing to "
          "repeat.");
    // The fit does not use the references of the other stations.
    for (CorrectedRow& row : result.rows)
        for (std::size_t k = 4; k < result.stations.size(); ++k)
            if (row.row.site == result.stations[k].site) row.is_used = false;
    CHECK_THAT(answer(result, all_good(result)),
               StartsWith("8 stations; u is 1.5 to 1.5 mGal. Only 4 known stations could be left "
                          "out to test it: they are off by 2.4 mGal rms."));
    for (StationValue& station : result.stations) station.left_out.reset();
    result.stations.back().u_gravity = MilliGal(2.04);
    CHECK_THAT(answer(result, all_good(result)),
               StartsWith("8 stations; u is 1.5 to 2.0 mGal, not tested"));
    result.stations.back().coverage_factor = 2.57;  // of five degrees of freedom
    CHECK_THAT(answer(result, all_good(result)), StartsWith("8 stations; u is"));
    result.stations.back().coverage_factor = 2.78;  // of four
    CHECK_THAT(answer(result, all_good(result)), ContainsSubstring("do not show how well"));
    for (StationValue& station : result.stations) station.u_gravity.reset();
    CHECK_THAT(answer(result, all_good(result)), ContainsSubstring("do not show how well"));
    result.stations.resize(1);
    CHECK_THAT(answer(result, all_good(result)), StartsWith("One station; this model"));
}

TEST_CASE("the answer names what to repeat, first where a station has no other reading to trust") {
    SurveyCorrection result = scattered_day();
    LeftOut stay;
    stay.site = "S9";
    stay.occupation = 2;
    stay.reason = "no samples";
    result.left_out = {stay};
    std::vector<ReadingGrade> grades = all_good(result);
    grades[1] = {Grade::repeat, {{"x", {}, "x"}}};  // S1, its only reading
    grades[2] = {Grade::repeat, {{"y", {}, "y"}}};  // S2, read again later
    grades[5] = {Grade::care, {{"z", {}, "z"}}};    // S4
    CHECK_THAT(answer(result, grades),
               EndsWith(" Repeat: S9 (2), S1 (1). If there is time, repeat: S2 (1)."));
    CHECK(notes(result, grades) ==
          std::vector<std::string>{"S9 (2): no value (no samples).", "S1 (1), repeat: x.",
                                   "S2 (1), repeat: y.", "S4 (1), care: z."});
    const Table table = answer_table(result, grades);
    REQUIRE(table.rows.size() == 8);
    CHECK(table.rows[0].back() == "trust");
    CHECK(table.rows[1].back() == "repeat");
    CHECK(table.rows[2].back() == "trust");
}

TEST_CASE("the answer says to look at findings first, but not at remarks") {
    SurveyCorrection result = scattered_day();
    result.findings = {{.kind = FindingKind::short_stay}};
    CHECK_THAT(answer(result, all_good(result)), EndsWith("Nothing to repeat."));
    result.findings.push_back({.kind = FindingKind::reference});
    result.findings.back().text = "said above";
    CHECK_THAT(answer(result, all_good(result)), EndsWith("First look at what was found (below)."));
    std::vector<ReadingGrade> grades = all_good(result);
    grades[1] = {Grade::repeat, {{"x", {}, "said above"}}};
    CHECK(notes(result, grades).empty());
    CHECK_THAT(answer(result, grades), EndsWith("(below). Repeat: S1 (1)."));
    result.findings.back().amendment = "[[reference]]\n";
    CHECK_THAT(answer(result, grades), EndsWith("(below)."));
    result.findings.push_back({.kind = FindingKind::unusable_day});
    CHECK_THAT(answer(result, all_good(result)),
               StartsWith("8 stations, but this day cannot be used as it is."));
}

TEST_CASE("u is that of the scatter if the readings scatter more than stated") {
    SurveyCorrection result = scattered_day();
    for (StationValue& station : result.stations) {
        station.u_gravity = MilliGal(0.5);
        station.u_a_posteriori = MilliGal(40.0);
    }
    NetworkPart part;
    part.dof = 6;
    part.weighted_square = 14.0;
    part.chi_square_high = 14.4;
    part.held_sites = {result.stations[0].site};
    result.own = part;
    const auto table = [&] { return answer_table(result, grade_readings(result)); };
    REQUIRE(table().headings[3] == "u mGal");
    CHECK(std::stod(table().rows[0][3]) == 0.5);
    part.weighted_square = 100.0;
    result.own = part;
    CHECK(std::stod(table().rows[0][3]) == 40.0);
    // All readings have this doubt, so it is said once.
    const std::vector<std::string> said = notes(result, grade_readings(result));
    CHECK(std::ranges::count_if(said, [](const std::string& note) {
              return note.find("scatter more than stated") != std::string::npos;
          }) == 1);
    result.score.loso_mgal.reset();
    result.stations[0].u_a_posteriori = MilliGal(0.1);  // held, so it is not that of a new one
    CHECK_THAT(answer(result, grade_readings(result)), StartsWith("8 stations; u is 40 to 40"));
    CHECK_THAT(answer(result, grade_readings(result)), !EndsWith("Nothing to repeat."));
    part.dof = 4;
    result.own = part;
    CHECK_THAT(answer(result, grade_readings(result)), ContainsSubstring("do not show how well"));
    CHECK(table().headings[3] != "u mGal");
}

TEST_CASE("the difference of a station is measured minus reference") {
    SurveyCorrection result = scattered_day();
    StationValue& station = result.stations[1];
    station.left_out = *station.reference + MilliGal(3.0);
    Table table = answer_table(result, all_good(result));
    REQUIRE(table.headings[4] == "Measured - reference, left out");
    CHECK(std::stod(table.rows[1][4]) == 3.0);
    for (StationValue& one : result.stations) one.left_out.reset();
    station.gravity = *station.reference - MilliGal(2.0);
    table = answer_table(result, all_good(result));
    REQUIRE(table.headings[4] == "Gravity - reference, in sample");
    CHECK(std::stod(table.rows[1][4]) == -2.0);
}

TEST_CASE("a station with one reading and no reference is named, because nothing checks it") {
    SurveyCorrection result = scattered_day();
    for (StationValue& station : result.stations) station.reference.reset();
    CHECK_THAT(notes(result, all_good(result)).back(),
               EndsWith("nothing checks them: S1, S4, S5, S6, S7."));
}

TEST_CASE("findings keep their numbers in the text, and no line is too long") {
    SurveyCorrection result = scattered_day();
    std::string words;
    for (int i = 0; i < 60; ++i) words += "word ";
    result.findings = {{.kind = FindingKind::reference, .text = words},
                       {.kind = FindingKind::short_stay, .text = "a remark"}};
    const std::string text = survey_text(result, false);
    CHECK_THAT(text, ContainsSubstring("\n1. word") && ContainsSubstring("\n2. a remark\n"));
    CHECK(text.find("2. a remark") > text.find("Station"));
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) CHECK(line.size() <= 118);
    CHECK_FALSE(text.find("LOSO") < text.size());
    CHECK_THAT(survey_text(result, true), StartsWith(text) && ContainsSubstring("LOSO"));
}
