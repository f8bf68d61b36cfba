#include "corrector/model/trend_comparison.hpp"

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;

namespace {

CorrectedRow row(const std::string& site, int occupation, std::optional<double> difference_mgal) {
    CorrectedRow corrected;
    corrected.row.site = site;
    corrected.row.occupation = occupation;
    if (difference_mgal) {
        RecordSummary& record = corrected.row.record.emplace();
        record.eemd_mean = MilliGal(979'800.0);
        record.smoother_mean = record.eemd_mean + MilliGal(*difference_mgal);
    }
    return corrected;
}

}  // namespace

TEST_CASE("the difference of the trends is summarised with the site of the largest", "[survey]") {
    SurveyCorrection result;
    CHECK(trend_comparison_text(result).empty());
    result.rows = {row("No.0", 1, 0.3), row("No.5", 2, -0.4), row("No.7", 1, std::nullopt)};
    CHECK(trend_comparison_text(result) ==
          "trends, smoother minus EEMD: mean -0.050, rms 0.354, largest -0.400 mGal at No.5 (2)\n");
}
