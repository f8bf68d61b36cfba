#include "corrector/mistake/survey_remarks.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <set>

#include "corrector/model/outlier_tests.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::mistake {
namespace {

using reading::Finding;
using reading::FindingKind;

/// Returns the middle value; of an even number the upper one.
double middle_of(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

/// A reading whose temperature moved is doubtful if its uncertainty is so many times the median.
constexpr double kUncertain = 1.5;

/// Says of which readings the temperature moved by more than the model corrects: it has no rate, the
/// row is outside the fit, or the uncertainty is much larger than that of other readings.
std::vector<Finding> moving_temperatures(const model::SurveyCorrection& result) {
    const bool corrects_rate = std::ranges::any_of(result.rows, [](const model::CorrectedRow& row) {
        return row.rate_correction != MilliGal(0.0);
    });
    std::vector<double> u_mgal;
    for (const model::CorrectedRow& row : result.rows)
        if (row.u_corrected) u_mgal.push_back(row.u_corrected->value());
    const double usual_mgal = u_mgal.empty() ? 0.0 : middle_of(std::move(u_mgal));
    std::vector<Finding> findings;
    for (const model::CorrectedRow& row : result.rows) {
        std::string doubt = model::temperature_doubt(row.row);
        if (doubt.empty() || row.row.is_excluded) continue;
        const bool is_uncertain =
            row.u_corrected && row.u_corrected->value() > kUncertain * usual_mgal;
        if (corrects_rate && row.is_used && !is_uncertain) continue;
        if (const auto at = doubt.find(';'); at != std::string::npos) doubt.replace(at, 1, ", ");
        Finding& finding = findings.emplace_back(
            Finding{.kind = FindingKind::temperature_moving, .code = "temperature_moving"});
        set_stay(finding, row.row.site, row.row.occupation, row.row.key, row.row.time);
        finding.text = text::message(
            "{} ({}): its temperature was still moving ({}; limits: {} degC/h, {} degC), {}",
            row.row.site, row.row.occupation, doubt,
            text::fixed(model::kGreatestRate_degc_per_h, 1),
            text::fixed(model::kGreatestRange_degc, 2),
            !row.is_used     ? text::message("and it is not in the fit")
            : !corrects_rate ? text::message("which the model does not correct")
                             : text::message("and its u is {} mGal, {} in the middle of the day's",
                                             text::fixed(row.u_corrected->value(), 1),
                                             text::fixed(usual_mgal, 1)));
    }
    return findings;
}

/// Says that the base has one stay only.
std::optional<Finding> base_not_revisited(const model::SurveyCorrection& result) {
    constexpr std::size_t kFewestStays = 5;  // a shorter list is no survey day
    std::set<std::pair<std::string, int>> stays;
    for (const model::CorrectedRow& row : result.rows)
        stays.emplace(row.row.site, row.row.occupation);
    const std::string& base = result.options.base;
    const auto is_base = [&](const auto& stay) { return stay.first == base; };
    if (stays.size() < kFewestStays || std::ranges::count_if(stays, is_base) != 1)
        return std::nullopt;
    Finding finding{
        .kind = FindingKind::base_not_revisited, .code = "base_not_revisited", .site = base};
    finding.text = text::message(
        "the base {} has 1 stay of {}, at least 2 show a drift without the references", base,
        stays.size());
    return finding;
}

std::optional<Finding> not_visited(const std::vector<reading::SurveyRow>& rows,
                                   const std::vector<text::Site>& sites) {
    constexpr std::size_t kMostNames = 10;
    std::vector<std::string> names;
    for (const text::Site& site : sites)
        if (std::ranges::find(rows, site.name, &reading::SurveyRow::site) == rows.end())
            names.push_back(site.name);
    if (names.empty()) return std::nullopt;
    Finding finding{.kind = FindingKind::not_visited, .code = "not_visited"};
    const std::size_t more = names.size() - std::min(names.size(), kMostNames);
    names.resize(names.size() - more);
    finding.text = text::message("without a reading in this day: {}{}", text::joined(names),
                                 more == 0 ? text::Message() : text::message(" and {} more", more));
    return finding;
}

}  // namespace

std::vector<Finding> survey_remarks(const model::SurveyCorrection& result,
                                    const std::vector<reading::SurveyRow>& rows,
                                    const std::vector<text::Site>& sites) {
    std::vector<Finding> remarks = moving_temperatures(result);
    if (auto finding = base_not_revisited(result)) remarks.push_back(std::move(*finding));
    if (auto finding = not_visited(rows, sites)) remarks.push_back(std::move(*finding));
    return remarks;
}

}  // namespace a351::corrector::mistake
