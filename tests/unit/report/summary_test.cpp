#include "corrector/report/summary.hpp"

#include "tests/support/catch.hpp"

#include "corrector/model/survey_correction.hpp"
#include "corrector/report/html.hpp"
#include "tests/unit/model/survey_rows.hpp"

using namespace a351::corrector;
using namespace a351;
using namespace a351::corrector::judgement;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;
using namespace a351::corrector::report;

namespace {

SurveyCorrection corrected(const std::vector<SurveyRow>& rows) {
    SurveyOptions options;
    options.model = "t-rate-drift";
    return correct_survey(rows, options);
}

/// Returns good readings with some scatter.
std::vector<SurveyRow> scattered_day() {
    auto rows = made_up::day();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].acceleration = rows[i].acceleration + MilliGal(i % 2 == 0 ? 0.5 : -0.5);
    }
    return rows;
}

/// Returns the first sections as they are in the page.
std::string summary_text(const SurveyCorrection& result, const std::vector<std::string>& warnings,
                         const std::vector<std::string>& missing) {
    const Page page("");
    add_head(page.body(), result, warnings, missing);
    add_findings(page.body(), result.findings);
    add_actions(page.body(), result);
    add_accuracy(page.body(), result);
    return page.text();
}

}  // namespace

TEST_CASE("readings are grouped by what to do about them", "[report][summary]") {
    auto rows = scattered_day();
    rows[1].is_flagged = true;  // S1, its only reading
    rows[2].is_flagged = true;  // S2, read again later
    rows[5].notes = {"gap"};    // S4
    SurveyCorrection result = corrected(rows);
    LeftOut stay;
    stay.site = "S9";
    stay.occupation = 2;
    stay.reason = "no samples";
    result.left_out = {stay, stay};
    result.left_out[1].site = "S8";
    result.left_out[1].occupation = 1;
    std::vector<ReadingGrade> grades(rows.size());
    grades[1].grade = grades[2].grade = Grade::repeat;
    grades[5].grade = Grade::care;
    const std::vector<std::string> list = actions(result, grades);
    REQUIRE(list.size() == 5);
    CHECK(list[0] == "Repeat, without a value (no samples): S9 (2), S8 (1).");
    CHECK(list[1] == "Repeat, the station has no other reading to trust: S1 (1).");
    CHECK(list[2] == "Repeat if there is time, the station has another reading to trust: S2 (1).");
    CHECK(list[3] == "Use with care: S4 (1).");
    CHECK(list[4] == "Trust: B (1), S3 (1), B (2), S5 (1), S6 (1), S7 (1), S2 (2), S3 (2), B (3).");
}

TEST_CASE("the summary says so if nothing must be repeated", "[report][summary]") {
    const SurveyCorrection result = corrected(scattered_day());
    const std::vector<ReadingGrade> all_good(result.rows.size());
    const std::vector<std::string> list = actions(result, all_good);
    REQUIRE(list.size() == 2);
    CHECK(list[0] == "No reading needs to be repeated.");
    CHECK_THAT(list[1], StartsWith("Trust: "));
}

TEST_CASE("the limits name the readings and stations that nothing checks", "[report][summary]") {
    auto rows = scattered_day();
    rows[7].reference.reset();  // S6
    const std::vector<std::string> limits = limits_of(corrected(rows));
    REQUIRE(limits.size() == 2);
    CHECK_THAT(limits[0], StartsWith("5 of 8 stations have only one reading"));
    CHECK_THAT(limits[1], EndsWith("nothing checks them: S6."));
    rows[4].is_flagged = true;  // the second reading of the base
    CHECK_THAT(limits_of(corrected(rows)).front(),
               StartsWith("Readings of the base B in the fit: 2;"));
}

TEST_CASE("the scatter is given with its own standard error", "[report][summary]") {
    model::Score score;
    score.row_count = 16;
    score.parameter_count = 2;
    score.dof = 14;
    score.rms_mgal = 2.0084;
    score.loso_mgal = 2.276;
    CHECK(standard_error_of_rms(score).value() == Approx(2.0084 / std::sqrt(28.0)));
    CHECK_THAT(scatter_sentence(score),
               StartsWith("n = 16: the scatter of 2.01 mGal (in sample) has itself a "
                          "standard error of about 0.38 mGal") &&
                   EndsWith("2.28 mGal (cross-validated, leave-one-station-out)."));
    score.dof = 0;
    CHECK_FALSE(standard_error_of_rms(score).has_value());
    CHECK_THAT(scatter_sentence(score), ContainsSubstring("say nothing about accuracy"));
    score.model = "day";
    score.loso_mgal.reset();
    CHECK_THAT(
        scatter_sentence(score),
        EndsWith(
            "For a new station quote its u, which includes what is not known of the instrument."));
}

TEST_CASE("the summary says of every accuracy figure whether it is in sample or cross-validated",
          "[report][summary]") {
    const std::string html = summary_text(corrected(scattered_day()), {"a"}, {"figures <missing>"});
    CHECK_THAT(html, ContainsSubstring("<td>in sample</td>") &&
                         ContainsSubstring("<td>cross-validated (leave-one-out)</td>") &&
                         ContainsSubstring("<td>cross-validated (leave-one-station-out)</td>") &&
                         ContainsSubstring("Remarks and warnings: 1,") &&
                         ContainsSubstring("figures &lt;missing&gt;"));
}

TEST_CASE("a proposed amendment keeps its lines and characters", "[report][summary]") {
    SurveyCorrection result = corrected(scattered_day());
    Finding finding;
    finding.text = "a <step>";
    finding.amendment = "[[step]]\nreason = \"S1 & S2\"\n";
    result.findings = {finding};
    CHECK_THAT(summary_text(result, {}, {}),
               ContainsSubstring("<li>a &lt;step&gt;</li>") &&
                   ContainsSubstring("<pre>[[step]]\nreason = \"S1 &amp; S2\"\n</pre>"));
}

TEST_CASE("the stations of a network count as unknowns, not as coefficients of its readings",
          "[report][summary]") {
    SurveyOptions options;
    options.model = "network";
    const SurveyCorrection result = correct_survey(scattered_day(), options);
    // 12 readings, 8 datum and a prior of the scale for 8 stations, constant, drift, temperature,
    // scale.
    CHECK(result.score.dof == 9);
    CHECK(standard_error_of_rms(result.score).value() ==
          Approx(*result.score.rms_mgal / std::sqrt(18.0)));
    CHECK_THAT(scatter_sentence(result.score), ContainsSubstring("with 9 degrees of freedom"));
    CHECK_THAT(
        summary_text(result, {}, {}),
        ContainsSubstring("readings in the fit: 12. Unknowns: 12, of which stations: 8 (8 held); "
                                 "degrees of freedom: 9."));
}

TEST_CASE("a prior adds a degree of freedom", "[report][summary]") {
    SurveyOptions options;
    options.model = "t-rate-drift";
    set_prior(options.priors, "test", "rate_mgal_per_degc_per_h", {10.0, 6.0});
    const SurveyCorrection result = correct_survey(scattered_day(), options);
    CHECK(result.score.dof == 12 + 1 - 4);
}

TEST_CASE(
    "the summary shows the whole-day model's error of predicting a station without its readings",
    "[report][summary]") {
    SurveyCorrection result = corrected(scattered_day());
    CorrectedRow& row = result.rows[0];
    row.row.notes = {"gap"};
    CHECK_THAT(summary_text(result, {}, {}), ContainsSubstring("corrected (in sample); u:"));
    row.own.emplace<WholeDayRow>().left_out = *row.row.reference - MilliGal(7.77);
    result.own = WholeDayPart{};
    CHECK_THAT(summary_text(result, {}, {}), ContainsSubstring("left out (cross-validated); u:") &&
                                                 ContainsSubstring("<td class=\"r\">7.77</td>"));
}
