#include "corrector/result/paper_report.hpp"

#include <cmath>
#include <optional>

#include "corrector/result/columns.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::result {
namespace {

constexpr int kDecimals = 3;  // as printed

std::optional<MilliGal> error1_of(const model::CorrectedRow& row) {
    const auto& residual = row.as<model::PaperRow>()->residual1;
    return residual ? std::optional(-*residual) : std::nullopt;
}

std::optional<MilliGal> error2_of(const model::CorrectedRow& row) {
    return row.residual ? std::optional(-*row.residual) : std::nullopt;
}

/// Returns the rms of an error over the readings in the fit: divisor n, as printed.
std::string rms_of(const model::SurveyCorrection& result,
                   std::optional<MilliGal> (*error_of)(const model::CorrectedRow&)) {
    double sum = 0.0;
    std::size_t count = 0;
    for (const model::CorrectedRow& row : result.rows) {
        const auto error = error_of(row);
        if (!row.is_used || !error) continue;
        sum += error->value() * error->value();
        ++count;
    }
    return count == 0 ? "-" : text::fixed(std::sqrt(sum / static_cast<double>(count)), kDecimals);
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
    add("error1_mgal", text::marked("Error (1)"), error1_of);
    add("corrected2_mgal", text::marked("Corrected (2)"),
        [](const Row& row) { return row.corrected; });
    add("error2_mgal", text::marked("Error (2)"), error2_of);
    const auto used = with_keys(occupation_columns(result), {"used"});
    columns.insert(columns.end(), used.begin(), used.end());
    return table_of(with_decimals(columns, kDecimals), result.rows);
}

std::string paper_errors(const model::SurveyCorrection& result) {
    return text::tr(
        "RMS of the readings in the fit (in sample): Error (1) {} mGal, Error (2) {} mGal.",
        rms_of(result, error1_of), rms_of(result, error2_of));
}

}  // namespace a351::corrector::result
