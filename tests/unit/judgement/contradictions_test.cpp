#include "corrector/judgement/contradictions.hpp"

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::judgement;

namespace {

WholeDayRow left_out(double mgal) {
    WholeDayRow own;
    own.left_out = MilliGal(mgal);
    return own;
}

/// Returns a day whose known stations are all on their references, but for `off` uncertainties.
SurveyCorrection day(const std::vector<std::string>& sites, double off) {
    SurveyCorrection result;
    for (std::size_t i = 0; i < sites.size(); ++i) {
        CorrectedRow& row = result.rows.emplace_back();
        row.row.site = sites[i];
        row.row.key = "K" + std::to_string(i);
        row.row.time = UtcTime(std::chrono::minutes(30 * i));
        row.row.reference = MilliGal(979800.0);
        row.own = left_out(979800.0 + 2.0 * off);
        row.studentised_residual = -off;
        if (i == 0 || sites[i] != sites[i - 1]) {
            StationValue& station = result.stations.emplace_back();
            station.site = sites[i];
        }
    }
    return result;
}

std::string said(const SurveyCorrection& result) {
    std::string text;
    for (const Contradiction& one : contradictions(result))
        text += (one.is_lesser ? "lesser " : "") + one.key + ' ' + one.text.english() + '|';
    return text;
}

}  // namespace

TEST_CASE("known stations contradict from four uncertainties on; of two neither is named alone") {
    CHECK(said(day({"A", "B"}, 3.0)).empty());
    const std::string of_both =
        "K0 A and B contradict each other by 8.0 mGal: one of them has a wrong name or reference; "
        "read a third known benchmark|";
    SurveyCorrection two = day({"A", "B"}, 4.0);
    CHECK(said(two) == "lesser " + of_both);
    two.rows[1].studentised_residual = 4.1;  // The same is said, of the same stay.
    CHECK(said(two) == of_both);
    CHECK(said(day({"A", "B"}, 35.0)) ==
          "K0 A and B contradict each other by 70.0 mGal: one of them has a wrong name or "
          "reference; read a third known benchmark|");
    SurveyCorrection three = day({"A", "B", "C"}, 0.0);
    three.rows[1].studentised_residual = 5.0;
    three.rows[1].own = left_out(979790.0);
    CHECK(said(three) ==
          "K1 B (1) differs from its reference by 10.0 mGal: check its name and its reference, "
          "then read it again|");
    three.rows[1].studentised_residual = 3.9;
    CHECK(said(three).starts_with("lesser K1 B (1) differs"));
    three.rows[1].row.is_reference_refused = true;
    CHECK(said(three).empty());
}

TEST_CASE("a lesser contradiction hides no greater one of its stay") {
    SurveyCorrection references = day({"A", "B", "B", "C"}, 0.0);
    references.rows[1].studentised_residual = 3.5;
    references.rows[2].studentised_residual = 4.5;
    CHECK(said(references).starts_with("K2 B (1) differs"));
    SurveyCorrection both = day({"A", "B", "B", "C"}, 0.0);
    both.rows[1].studentised_residual = 3.2;
    both.rows[2].corrected = MilliGal(12.0);
    CHECK(said(both).starts_with("K2 B (1a) and B (1b) differ by 12.0 mGal"));
    SurveyCorrection three = day({"A", "B", "B", "B"}, 0.0);
    three.rows[2].corrected = MilliGal(6.0);
    three.rows[3].corrected = MilliGal(-6.0);
    CHECK(said(three).starts_with("K"));
    CHECK(contradictions(three).size() == 1);
}

TEST_CASE(
    "two stations that contradict each other enlarge all uncertainties, one of many does not") {
    CHECK(doubt_factor(day({"A", "B"}, 0.5)) == 1.0);
    CHECK(doubt_factor(day({"A", "B"}, 6.745)) == Approx(10.0).epsilon(1e-3));
    SurveyCorrection many = day({"A", "B", "C", "D", "E"}, 0.5);
    many.rows[2].studentised_residual = 15.0;
    CHECK(doubt_factor(many) == 1.0);
}

TEST_CASE("set-ups of a stay contradict when they differ by more than their placement allows") {
    SurveyCorrection result = day({"A", "B", "B"}, 0.0);
    result.rows[2].corrected = MilliGal(5.0);  // 3 x sqrt 2 x 1.2 = 5.09
    CHECK(said(result).empty());
    result.rows[2].corrected = MilliGal(6.7);  // 4 x sqrt 2 x 1.2 = 6.79
    CHECK(said(result).starts_with("lesser K2 B (1a) and B (1b) differ"));
    result.rows[2].corrected = MilliGal(12.0);
    CHECK(said(result) ==
          "K2 B (1a) and B (1b) differ by 12.0 mGal, 7.1 times what their placement allows: read "
          "it again if you pass there|");
    CHECK(contradictions(result, "K2")
              .front()
              .text.english()
              .ends_with("lift the box, set it down level, and add a set-up"));
    // A third set-up, with the first or with neither, does not hide it.
    for (const double third : {0.0, 24.0}) {
        SurveyCorrection three = day({"A", "B", "B", "B"}, 0.0);
        three.rows[2].corrected = MilliGal(12.0);
        three.rows[3].corrected = MilliGal(third);
        CHECK(contradictions(three).size() == 1);
    }
    // The other stays show the placement of this box.
    SurveyCorrection rough = day({"A", "A", "B", "B", "C", "C", "D", "D"}, 0.0);
    for (const std::size_t i : {1U, 3U, 5U, 7U}) rough.rows[i].corrected = MilliGal(8.0);
    CHECK(said(rough).empty());
    result.rows[2].row.occupation = 2;  // another stay
    CHECK(said(result).empty());
}

TEST_CASE("a mistake of the search is a contradiction, and its reading is named once") {
    SurveyCorrection result = day({"A", "B", "C"}, 9.0);
    result.findings = {{.kind = corrector::reading::FindingKind::reference,
                        .code = "reference",
                        .site = "A",
                        .occupation = 1,
                        .key = "K0",
                        .text = "the reference of A is wrong"},
                       {.kind = corrector::reading::FindingKind::not_visited, .text = "D"},
                       {.kind = corrector::reading::FindingKind::moved_box, .text = "moved"}};
    const auto all = contradictions(result);
    REQUIRE(all.size() == 3);
    CHECK(all[0].text == "the reference of A is wrong");
    CHECK(all[1].site == "B");
    CHECK(all[2].site == "C");
}
