#include "corrector/judgement/reading_grade.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>

#include "corrector/judgement/reading_name.hpp"
#include "corrector/judgement/unlike_neighbours.hpp"

using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;
using namespace a351::corrector::judgement;

namespace {

/// Returns readings of different stations, a day apart, exactly at the limits of trust.
SurveyCorrection quiet(std::size_t count) {
    SurveyCorrection result;
    result.score.s_mgal = 2.0;
    for (std::size_t i = 0; i < count; ++i) {
        CorrectedRow row;
        row.row.site = std::string(1, static_cast<char>('A' + i));
        row.row.time = UtcTime(std::chrono::days(i));
        row.row.rate_degc_per_h = 0.2;
        row.is_used = true;
        row.residual = MilliGal(4.0);
        row.u_corrected = MilliGal(2.0);
        result.rows.push_back(row);
        StationValue& station = result.stations.emplace_back();
        station.site = row.row.site;
    }
    return result;
}

Grade first_grade(const SurveyCorrection& result) { return grade_readings(result).front().grade; }

/// Returns the grade of the first reading, and its reasons.
std::string first(const SurveyCorrection& result) {
    const ReadingGrade grade = grade_readings(result).front();
    std::string text = std::string(grade_name(grade.grade)) + ": ";
    for (const Reason& reason : grade.reasons) text += reason.text.english() + '|';
    return text;
}

}  // namespace

TEST_CASE("a reading at its limits is trusted") {
    const SurveyCorrection result = quiet(2);
    CHECK(first(result) == "trust: ");
    CHECK(grade_of_station(result, grade_readings(result), "B").grade == Grade::trust);
}

TEST_CASE("no reading of a survey is trusted if the survey as a whole is not") {
    SurveyCorrection network = quiet(2);
    NetworkPart part;
    part.dof = 4;
    part.weighted_square = 15.9;  // fails, with less than twice the scatter stated
    part.chi_square_high = 11.1;
    network.own = part;
    CHECK(first_grade(network) == Grade::trust);
    part.weighted_square = 16.1;
    network.own = part;
    CHECK(first(network) == "care: the readings scatter more than stated (global test failed)|");

    SurveyCorrection unusable = quiet(2);
    unusable.findings.push_back({.kind = FindingKind::unusable_day, .text = "not usable"});
    CHECK(first(unusable) == "care: not usable|");
}

TEST_CASE("a moving temperature is graded repeat, or care if the model has a rate term") {
    SurveyCorrection result = quiet(2);
    result.rows[0].row.rate_degc_per_h = -0.21;
    CHECK(first(result) ==
          "repeat: temperature not steady: rate -0.210 degC/h, which the model does not correct|");
    result.rows[0].rate_correction = MilliGal(5.25);
    CHECK_THAT(first(result), StartsWith("care: ") &&
                                  ContainsSubstring("depends on a rate correction of 5.2 mGal"));
}

TEST_CASE("a temperature that moves one way is graded repeat above the limit of its range") {
    SurveyCorrection result = quiet(1);
    RecordSummary& record = result.rows[0].row.record.emplace();
    record.temperature_range = DegC(0.051);
    record.temperature_shape = TemperatureShape::monotone;
    CHECK(first_grade(result) == Grade::repeat);
    record.temperature_shape = TemperatureShape::turning;
    CHECK(first_grade(result) == Grade::trust);
    record.temperature_shape = TemperatureShape::half_wave;
    CHECK(first_grade(result) == Grade::repeat);
}

TEST_CASE("the whole-day model is graded by its prediction without the station") {
    SurveyCorrection result = quiet(1);
    result.own = WholeDayPart{};
    result.rows[0].residual = MilliGal(9.0);
    result.rows[0].studentised_residual = -1.9;
    CHECK(first_grade(result) == Grade::trust);
    result.rows[0].studentised_residual = 3.1;
    CHECK(first(result) ==
          "repeat: 6.2 mGal above its reference when its station is left out, 3.1 times "
          "the uncertainty expected if name and reference are right|");
}

TEST_CASE("a reading with a scatter above its uncertainty is graded care, a shaken one repeat") {
    SurveyCorrection result = quiet(1);
    result.rows[0].row.record.emplace();
    auto& record = *result.rows[0].row.record;
    record.standard_error = MilliGal(2.0);
    record.rectification = MilliGal(2.0);
    CHECK(first_grade(result) == Grade::trust);
    record.standard_error = MilliGal(2.1);
    CHECK(first(result) ==
          "care: its samples scatter: their mean is known to 2.1 mGal only (u: 2.0 mGal)|");
    // A gravimeter needs more digits.
    result.rows[0].u_corrected = MilliGal(0.005);
    result.rows[0].residual.reset();
    record.standard_error = MilliGal(0.0123);
    record.rectification = MilliGal(0.0);
    CHECK(first(result) ==
          "care: its samples scatter: their mean is known to 0.0123 mGal only (u: 0.0050 mGal)|");
    result.rows[0].u_corrected = MilliGal(2.0);
    record.standard_error.reset();
    record.rectification = MilliGal(77.6);
    CHECK(first(result) ==
          "repeat: the box was shaken as on a drive: this changes the norm of its samples by 77.6 "
          "mGal, "
          "more than its u of 2.0 mGal|");
}

TEST_CASE("set-ups of one station are compared by the placement scatter of the whole-day model") {
    SurveyCorrection result = quiet(2);
    result.own = WholeDayPart{};
    result.score.s_mgal.reset();
    result.coefficients = {{"flicker_mgal", 9.0, {}}, {"placement_mgal", 1.5, {}}};
    result.rows[1].row.site = "A";
    result.stations.pop_back();
    result.rows[1].corrected = MilliGal(4.2);  // 2 sqrt(2) 1.5 = 4.24
    CHECK(first_grade(result) == Grade::trust);
    result.rows[1].corrected = MilliGal(4.3);
    CHECK(first(result) ==
          "care: differs by 4.3 mGal from A (1b), 2.0 times the value expected from placement|");
}

TEST_CASE(
    "what does not make the readings of the whole-day model worse does not lower their grade") {
    SurveyCorrection result = quiet(1);
    SurveyRow& row = result.rows[0].row;
    row.notes = {"pulse", "gap", "fallback", "disturbed_end", "unsettled", "moved", "no-stop"};
    row.rate_degc_per_h = 0.5;
    row.is_flagged = true;
    row.record.emplace().smoother_mean = MilliGal(3.0);
    result.own = WholeDayPart{};
    CHECK(first(result) == "trust: ");
}

TEST_CASE("a record split by a knock is graded care, except for the whole-day model") {
    SurveyCorrection result = quiet(1);
    result.rows[0].row.notes = {"pulse"};
    CHECK(first(result) == "care: a knock split the record; its longest part was used|");
}

TEST_CASE("a mistake found at a stay lowers its grade; a remark or a move of the box does not") {
    SurveyCorrection result = quiet(1);
    Finding finding{.code = "found", .site = "A", .occupation = 1, .text = "found"};
    const auto grade_with = [&](FindingKind kind) {
        finding.kind = kind;
        result.findings = {finding};
        return first_grade(result);
    };
    result.rows[0].row.occupation = 1;
    CHECK(grade_with(FindingKind::short_stay) == Grade::trust);
    CHECK(grade_with(FindingKind::moved_box) == Grade::trust);
    CHECK(grade_with(FindingKind::other_name) == Grade::care);
    CHECK(grade_with(FindingKind::bad_reading) == Grade::repeat);
}

TEST_CASE("an excluded reading is graded repeat, an amended one can be trusted") {
    SurveyCorrection result = quiet(1);
    result.rows[0].row.notes = {"excluded"};
    CHECK(first_grade(result) == Grade::repeat);
    result.rows[0].row.notes = {"retimed", "renamed"};
    CHECK(first_grade(result) == Grade::trust);
}

TEST_CASE("a residual above two u is graded care, above three u repeat") {
    SurveyCorrection result = quiet(1);
    result.rows[0].residual = MilliGal(4.1);
    CHECK_THAT(first(result),
               StartsWith("care: ") && ContainsSubstring("4.1 mGal above its reference"));
    result.rows[0].residual = MilliGal(-6.1);
    CHECK(first_grade(result) == Grade::repeat);
    result.rows[0].residual.reset();
    CHECK(first_grade(result) == Grade::trust);
}

TEST_CASE("a reading that the operator marked is graded repeat unless it is in the fit") {
    SurveyCorrection result = quiet(1);
    result.rows[0].row.is_flagged = true;
    CHECK(first_grade(result) == Grade::trust);
    result.rows[0].is_used = false;
    CHECK(first_grade(result) == Grade::repeat);
    result.options.use_flags = false;  // It has no reference that the fit holds.
    CHECK(first_grade(result) == Grade::trust);
}

TEST_CASE("readings of one station that disagree are both graded care") {
    SurveyCorrection result = quiet(2);
    result.rows[1].row.site = "A";
    result.rows[1].row.occupation = 2;
    result.stations.pop_back();
    result.rows[1].corrected = MilliGal(5.6);  // 2 sqrt(2) s = 5.66
    CHECK(first_grade(result) == Grade::trust);
    result.rows[1].corrected = MilliGal(5.7);
    CHECK(first(result) ==
          "care: differs by 5.7 mGal from A (2), 2.0 times the value expected from s|");
    CHECK(grade_readings(result)[1].reasons.front().text ==
          "differs by 5.7 mGal from A (1), 2.0 times the value expected from s");
    result.rows[1].row.rate_degc_per_h = 0.3;  // it must be repeated and is not used for comparison
    CHECK(first_grade(result) == Grade::trust);
}

TEST_CASE("of many readings of a station the worst pair is graded, with a limit for their number") {
    SurveyCorrection result = quiet(6);
    result.stations.resize(1);
    for (std::size_t i = 1; i < result.rows.size(); ++i) {
        result.rows[i].row.site = "A";
        result.rows[i].row.occupation = static_cast<int>(i) + 1;
    }
    // The studentised range of 15 pairs: 2.97 sqrt(2) s = 8.4 mGal.
    result.rows[2].corrected = MilliGal(8.3);
    CHECK(first_grade(result) == Grade::trust);
    result.rows[2].corrected = MilliGal(8.5);
    const std::vector<ReadingGrade> grades = grade_readings(result);
    CHECK(grades[2].reasons.size() == 1);
    CHECK(std::ranges::count(grades, Grade::care, &ReadingGrade::grade) == 2);
}

TEST_CASE("readings of a network are compared by the scatter that each states") {
    SurveyCorrection result = quiet(2);
    result.own = NetworkPart{};
    result.options.priors.reading_sd_mgal = 1.0;  // s is twice as large
    result.rows[1].row.site = "A";
    result.rows[1].row.occupation = 2;
    result.stations.pop_back();
    result.rows[0].row.u_average =
        MilliGal(3.0);  // s: hypot(2, 6), with the other 2: hypot(6.32, 2)
    result.rows[1].corrected = MilliGal(13.2);
    CHECK(first_grade(result) == Grade::trust);
    result.rows[1].corrected = MilliGal(13.3);
    CHECK(first_grade(result) == Grade::care);
}

TEST_CASE("a named mistake makes no other reading doubtful") {
    SurveyCorrection result = quiet(3);
    result.rows[0].residual = MilliGal(-20.0);
    result.rows[1].row.site = "A";
    result.rows[1].row.occupation = 2;
    result.rows[1].corrected = MilliGal(20.0);
    CHECK(first_grade(result) == Grade::repeat);
    result.findings.push_back({.kind = FindingKind::no_stop, .code = "remark"});
    CHECK(first_grade(result) == Grade::repeat);
    result.findings.push_back({.kind = FindingKind::other_name, .code = kUnlikeNeighboursCode, .site = "C"});
    CHECK(first_grade(result) == Grade::repeat);  // It was found without the other readings.
    const FindingKind kind = GENERATE(FindingKind::reference, FindingKind::other_name,
                                      FindingKind::step, FindingKind::bad_reading);
    result.findings.push_back({.kind = kind, .code = "mistake", .site = "C", .occupation = 1});
    CHECK(first_grade(result) == Grade::trust);
    CHECK(grade_readings(result)[1].grade == Grade::trust);
}

TEST_CASE("a station has the best grade of its readings, with their reasons") {
    SurveyCorrection result = quiet(3);
    result.rows[2].row.site = "A";
    result.rows[2].row.occupation = 2;
    result.stations.pop_back();
    const Reason x{"x", {}, "x"}, y{"y", {}, "y"};
    std::vector<ReadingGrade> grades{{Grade::repeat, {x}}, {Grade::repeat, {x, y}}, {}};
    CHECK(grade_of_station(result, grades, "A").grade == Grade::trust);
    CHECK(grade_of_station(result, grades, "A").reasons.empty());
    CHECK(reason_text(grade_of_station(result, grades, "B")) == "B (1): x; y");
    grades[2] = {Grade::care, {y}};
    CHECK(grade_of_station(result, grades, "A").grade == Grade::care);
    CHECK(reason_text(grade_of_station(result, grades, "A")) == "A (2): y");
}

TEST_CASE("set-ups of one stay are distinguished by letters") {
    SurveyCorrection result = quiet(3);
    result.rows[2].row.site = "A";
    CHECK(reading_name(result.rows, 0) == "A (1a)");
    CHECK(reading_name(result.rows, 1) == "B (1)");
    CHECK(reading_name(result.rows, 2) == "A (1b)");
}
