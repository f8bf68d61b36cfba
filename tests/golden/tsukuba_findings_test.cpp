#include "tests/support/catch.hpp"

#include "corrector/judgement/survey_findings.hpp"
#include "corrector/model/survey_correction.hpp"
#include "tests/golden/tsukuba_table.hpp"

using namespace a351::corrector;
using reading::Finding;

namespace {

std::vector<Finding> findings_of(const std::string& model, bool use_flags) {
    auto rows = tsukuba::observations();
    reading::set_backward_rates(rows);
    model::SurveyOptions options;
    options.model = model;
    options.use_flags = use_flags;
    const auto result = model::correct_survey(rows, options);
    return judgement::find_mistakes(result, {rows, tsukuba::sites(), nullptr});
}

}  // namespace

TEST_CASE("the published survey has no mistakes without the rows that it left out") {
    for (const std::string model : {"auto", "t", "t-rate-drift", "network", "paper"})
        CHECK(findings_of(model, true).empty());
}

TEST_CASE("with all published rows a model without the rate names the worst of those left out") {
    for (const std::string model : {"t", "t-drift", "network"}) {
        const auto findings = findings_of(model, false);
        REQUIRE(findings.size() == 1);
        CHECK(findings[0].kind == reading::FindingKind::bad_reading);
        CHECK(findings[0].site == "No.2");
        CHECK(findings[0].occupation == 1);
        CHECK_FALSE(findings[0].is_headline);
    }
    // The rate explains it.
    CHECK(findings_of("t-rate-drift", false).empty());
}
