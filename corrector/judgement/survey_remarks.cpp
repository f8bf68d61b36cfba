#include "corrector/judgement/survey_remarks.hpp"

#include <algorithm>
#include <optional>

#include "protocol/text/aligned_text.hpp"
#include "protocol/text/doubtful_site.hpp"

namespace a351::corrector::judgement {
namespace {

using reading::Finding;
using reading::FindingKind;

/// Says that the base has one stay only.
std::optional<Finding> base_not_revisited(const model::SurveyCorrection& result) {
    constexpr std::size_t kFewestStays = 5;  // a shorter list is no survey day
    const std::string& base = result.options.base;
    std::size_t stays = 0, at_base = 0;
    const reading::SurveyRow* before = nullptr;
    for (const model::CorrectedRow& row : result.rows) {
        // The numbers may be wrong, but what was read in between is not.
        const bool is_same = before != nullptr && reading::is_same_stay(*before, row.row);
        before = &row.row;
        if (is_same) continue;
        ++stays;
        if (row.row.site == base) ++at_base;
    }
    if (stays < kFewestStays || at_base != 1) return std::nullopt;
    Finding finding{
        .kind = FindingKind::base_not_revisited, .code = "base_not_revisited", .site = base};
    finding.text = text::message(
        "the base {} was read only once; a second stay would show a drift without any reference",
        base);
    return finding;
}

std::optional<Finding> doubt_about(const std::vector<text::Site>& sites) {
    const text::Message doubt = text::doubtful_site(sites);
    if (doubt.empty()) return std::nullopt;
    Finding finding{.kind = FindingKind::doubtful_site, .code = "doubtful_site"};
    finding.text = doubt;
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
    std::vector<Finding> remarks;
    if (auto finding = base_not_revisited(result)) remarks.push_back(std::move(*finding));
    const bool is_part_of_day =
        std::ranges::count(result.findings, FindingKind::other_unit, &Finding::kind) > 0;
    if (is_part_of_day) return remarks;  // The other sensor may have been there.
    if (auto finding = doubt_about(sites)) remarks.push_back(std::move(*finding));
    if (auto finding = not_visited(rows, sites)) remarks.push_back(std::move(*finding));
    return remarks;
}

}  // namespace a351::corrector::judgement
