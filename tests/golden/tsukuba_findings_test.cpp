#include "tests/support/catch.hpp"

#include "corrector/mistake/survey_findings.hpp"
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
    return mistake::find_mistakes(result, {rows, tsukuba::sites(), nullptr});
}

/// Returns the stays of findings with a temperature that moved, without the other findings.
std::vector<std::string> moving(const std::vector<Finding>& findings) {
    std::vector<std::string> stays;
    for (const Finding& finding : findings)
        if (finding.kind == reading::FindingKind::temperature_moving)
            stays.push_back(finding.site + " " + std::to_string(*finding.occupation));
    return stays;
}

}  // namespace

TEST_CASE("of the published survey only the rows that it left out are named, as what they are",
          "[tsukuba]") {
    const std::vector<std::string> left_out{"No.2 1", "No.5 2", "No.2 2"};
    for (const std::string model : {"auto", "t", "t-rate-drift", "network", "paper"}) {
        const auto findings = findings_of(model, true);
        auto stays = moving(findings);
        CHECK(stays.size() == findings.size());
        if (model != "t-rate-drift") {  // it corrects the rate of No.1 (2)
            REQUIRE(stays.size() == 4);
            CHECK(stays.back() == "No.1 2");
            stays.pop_back();
        }
        CHECK(stays == left_out);
        CHECK(findings[0].text ==
              "No.2 (1): its temperature was still moving (rate 0.447 degC/h; limits: 0.2 degC/h, "
              "0.05 degC), and it is not in the fit");
    }
}

TEST_CASE("with all published rows a model without the rate names the worst of those left out",
          "[tsukuba]") {
    for (const std::string model : {"t", "t-drift", "network"}) {
        const auto findings = findings_of(model, false);
        CHECK(moving(findings).size() + 1 == findings.size());
        CHECK(findings[0].kind == reading::FindingKind::bad_reading);
        CHECK(findings[0].site == "No.2");
        CHECK(findings[0].occupation == 1);
        CHECK_THAT(findings[0].text.english(),
                   ContainsSubstring("its temperature was not steady (rate 0.447 degC/h)"));
        CHECK_FALSE(findings[0].is_headline);
    }
    // The rate explains it.
    CHECK(findings_of("t-rate-drift", false).empty());
}
