#include "corrector/report/summary.hpp"

#include "corrector/model/survey_correction.hpp"
#include "corrector/report/html.hpp"
#include "tests/unit/model/survey_rows.hpp"

using namespace a351::corrector;
using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;
using namespace a351::corrector::report;

namespace {

SurveyCorrection corrected(const std::vector<SurveyRow>& rows) {
    return correct_survey(rows, {.model = "t-rate-drift"});
}

/// Returns good readings with some scatter.
std::vector<SurveyRow> scattered_day() { return made_up::day_with_errors({0.5, -0.5}); }

/// Returns the first parts as they are in the page.
std::string summary_text(const SurveyCorrection& result, std::size_t warning_count,
                         const std::vector<std::string>& missing) {
    const Page page("");
    add_answer(page.body(), result, missing);
    add_answer_table(page.body(), result);
    add_notes(page.body(), result, warning_count);
    add_accuracy(page.body(), result);
    return page.text();
}

}  // namespace

TEST_CASE("the scatter is given with its own standard error") {
    model::Score score;
    score.row_count = 16;
    score.parameter_count = 2;
    score.dof = 14;
    score.rms_mgal = 2.0084;
    CHECK(standard_error_of_rms(score).value() == Approx(2.0084 / std::sqrt(28.0)));
    CHECK_THAT(scatter_sentence(score),
               StartsWith("The RMS of the residuals (n = 16) has itself a standard error of 0.38 "
                          "mGal"));
    score.dof = 0;
    CHECK_FALSE(standard_error_of_rms(score).has_value());
    CHECK_THAT(scatter_sentence(score), ContainsSubstring("say nothing about accuracy"));
}

TEST_CASE("the answer shows missing figures, and how many warnings there are") {
    const std::string html = summary_text(corrected(scattered_day()), 1, {"figures <missing>"});
    CHECK_THAT(html, ContainsSubstring("Remarks and warnings: 1,") &&
                         ContainsSubstring("figures &lt;missing&gt;"));
}

TEST_CASE("a proposed amendment keeps its lines and characters") {
    SurveyCorrection result = corrected(scattered_day());
    Finding finding;
    finding.text = "a <step>";
    finding.amendment = "[[step]]\nreason = \"S1 & S2\"\n";
    result.findings = {finding};
    CHECK_THAT(summary_text(result, 0, {}),
               ContainsSubstring("<li>a &lt;step&gt;</li>") &&
                   ContainsSubstring("<pre>[[step]]\nreason = \"S1 &amp; S2\"\n</pre>"));
}

TEST_CASE("the stations of a network count as unknowns, not as coefficients of its readings") {
    const SurveyCorrection result = correct_survey(scattered_day(), {.model = "network"});
    // 12 readings, 8 datum and a prior of the scale for 8 stations, constant, drift, temperature,
    // scale.
    CHECK(result.score.dof == 9);
    CHECK(standard_error_of_rms(result.score).value() ==
          Approx(*result.score.rms_mgal / std::sqrt(18.0)));
    CHECK_THAT(scatter_sentence(result.score), ContainsSubstring("with 9 degrees of freedom"));
    CHECK_THAT(
        summary_text(result, 0, {}),
        ContainsSubstring("readings in the fit: 12. Unknowns: 12, of which stations: 8 (8 held); "
                          "degrees of freedom: 9."));
}

TEST_CASE("a prior adds a degree of freedom") {
    SurveyOptions options{.model = "t-rate-drift"};
    set_prior(options.priors, "test", "rate_mgal_per_degc_per_h", {10.0, 6.0});
    const SurveyCorrection result = correct_survey(scattered_day(), options);
    CHECK(result.score.dof == 12 + 1 - 4);
}
