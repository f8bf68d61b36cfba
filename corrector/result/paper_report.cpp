#include "corrector/result/paper_report.hpp"

#include <optional>

#include "corrector/result/columns.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::result {
namespace {

constexpr int kDecimals = 3;  // as printed

/// Returns reference - corrected.
std::optional<MilliGal> error_of(const std::optional<MilliGal>& residual) {
    return residual ? std::optional(-*residual) : std::nullopt;
}

}  // namespace

bool is_paper(const model::SurveyCorrection& result) {
    return !result.rows.empty() && result.rows.front().as<model::PaperRow>() != nullptr;
}

Table paper_table(const model::SurveyCorrection& result) {
    using Row = model::CorrectedRow;
    auto columns = with_keys(occupation_columns(result),
                             {"site", "occupation", "reference_mgal", "time_utc", "tide_mgal",
                              "acceleration_mgal", "temperature_degc", "difference_mgal"});
    const auto add = [&columns](std::string_view key, std::string_view heading, auto value) {
        columns.push_back(
            {key, [value](const Row& row) { return cell(value(row)); }, {heading, kDecimals}});
    };
    add("corrected1_mgal", text::marked("Corrected (1)"),
        [](const Row& row) { return row.as<model::PaperRow>()->corrected1; });
    add("error1_mgal", text::marked("Error (1)"),
        [](const Row& row) { return error_of(row.as<model::PaperRow>()->residual1); });
    add("corrected2_mgal", text::marked("Corrected (2)"),
        [](const Row& row) { return row.corrected; });
    add("error2_mgal", text::marked("Error (2)"),
        [](const Row& row) { return error_of(row.residual); });
    const auto used = with_keys(occupation_columns(result), {"used"});
    columns.insert(columns.end(), used.begin(), used.end());
    return table_of(with_decimals(columns, kDecimals), result.rows);
}

std::string paper_errors(const model::SurveyCorrection& result) {
    return text::tr(
        "RMS of the readings in the fit (in sample): Error (1) {} mGal, Error (2) {} mGal.",
        text::fixed_or(result.score.rms_before_drift_mgal, kDecimals, "-"),
        text::fixed_or(result.score.rms_mgal, kDecimals, "-"));
}

}  // namespace a351::corrector::result
