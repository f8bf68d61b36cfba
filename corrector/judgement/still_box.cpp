#include "corrector/judgement/still_box.hpp"

#include <cmath>

#include "corrector/judgement/reading_name.hpp"
#include "protocol/core/units.hpp"

namespace a351::corrector::judgement {
namespace {

using reading::SurveyRow;

constexpr double kLevel_deg = 0.001, kSetUpLevel_deg = 0.0003;
constexpr MilliGal kNorm(10.0);
constexpr std::size_t kFewestStill = 4;

bool has_moved(const SurveyRow& one, const SurveyRow& other, double level_deg) {
    if (!one.record || !other.record || one.face != other.face) return true;
    const double x = (other.record->x.mean - one.record->x.mean).value(),
                 y = (other.record->y.mean - one.record->y.mean).value();
    const double norm_mgal = (other.measured() - one.measured()).value();
    return !(std::hypot(x, y) * kDegPerRad <= level_deg && std::abs(norm_mgal) <= kNorm.value());
}

}  // namespace

std::optional<reading::Finding> still_box(const std::vector<SurveyRow>& rows) {
    std::size_t first = 0, stays = 1;
    for (std::size_t i = 1; i <= rows.size(); ++i) {
        if (i < rows.size() && !has_moved(rows[i - 1], rows[i], kLevel_deg)) {
            if (rows[i].site != rows[i - 1].site) ++stays;
            continue;
        }
        if (stays >= kFewestStill) {
            reading::Finding finding{.kind = reading::FindingKind::unusable_day,
                                     .code = "still_box",
                                     .is_headline = true};
            finding.text = text::message(
                "the box did not move from {} to {}, {} stays one after the other at different "
                "benchmarks: check date, hour and zone of the stays",
                stay_name(rows[first]), stay_name(rows[i - 1]), stays);
            return finding;
        }
        first = i;
        stays = 1;
    }
    return std::nullopt;
}

std::vector<reading::Finding> set_ups_not_lifted(const std::vector<SurveyRow>& rows) {
    std::vector<reading::Finding> findings;
    const SurveyRow* before = nullptr;  // The used set-up before.
    for (const SurveyRow& row : rows) {
        if (row.is_excluded || row.is_flagged) continue;
        const bool is_still = before != nullptr && reading::is_same_stay(*before, row) &&
                              !has_moved(*before, row, kSetUpLevel_deg);
        before = &row;
        if (!is_still) continue;
        reading::Finding& finding = findings.emplace_back(
            reading::Finding{.kind = reading::FindingKind::not_lifted, .code = "not_lifted"});
        set_stay(finding, row);
        finding.text = text::message(
            "{} ({}): the box was not lifted before the set-up at {}, so its placement was not "
            "averaged and u is too small",
            row.site, row.occupation, to_rfc3339(*finding.time));
        if (!row.listed.site.empty())
            finding.amendment =
                reading::amendment_head("exclude", row.listed) + "reason = \"box not lifted\"\n";
    }
    return findings;
}

}  // namespace a351::corrector::judgement
