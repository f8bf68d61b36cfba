#include "corrector/design/evening.hpp"

#include <algorithm>
#include <ranges>

#include "corrector/design/expected_errors.hpp"
#include "corrector/model/calibration_use.hpp"
#include "protocol/core/units.hpp"
#include "protocol/signal/median.hpp"

namespace a351::corrector::design {
namespace {

/// Drive to the base if the day has none yet.  Reason: the median between the middles of the
/// published readings is 30 min (observations.csv of tests/golden/tsukuba), a stay included.
constexpr double kUsualDrive_s = 1200.0;

/// Returns the visits of the day.  A stay whose set-ups are too short for a plan is left out.
Plan visits_so_far(const std::vector<model::CorrectedRow>& rows) {
    Plan plan;
    std::string last_key;
    for (const model::CorrectedRow& corrected : rows) {
        const reading::SurveyRow& row = corrected.row;
        if (!row.start || !row.end) continue;
        const bool is_same = !plan.empty() && row.key == last_key && row.site == plan.back().site;
        if (!is_same) plan.push_back({row.site, *row.start, 0, 0.0, ""});
        last_key = row.key;
        Visit& visit = plan.back();
        visit.faces += row.face < 0 ? '-' : '+';
        ++visit.set_ups;
        const double minutes = seconds_between(visit.start, *row.end) / kSecondsPerMinute;
        visit.minutes_each = std::min(minutes / visit.set_ups, kMostMinutes);
    }
    std::erase_if(plan, [](const Visit& visit) {
        return visit.minutes_each < kFewestMinutes || visit.set_ups > kMostSetUps;
    });
    return plan;
}

/// Returns the expected uncertainty of a station.
double expected_mgal(const Plan& plan, const std::vector<text::Site>& sites,
                     const PlannedUnit& unit, const std::string& site) {
    const ExpectedErrors errors = expected_errors(plan, sites, unit, Detail::stations);
    return std::ranges::find(errors.stations, site, &ExpectedStation::site)->u.value();
}

}  // namespace

std::optional<MilliGal> u_in_the_evening(const model::SurveyCorrection& result,
                                         const std::vector<text::Site>& sites,
                                         const std::string& key) {
    const auto* const day = result.as<model::WholeDayPart>();
    if (day == nullptr || key.empty()) return std::nullopt;
    const auto running =
        std::ranges::find(result.rows | std::views::reverse, key,
                          [](const model::CorrectedRow& row) { return row.row.key; });
    if (running == result.rows.rend() || running->row.reference) return std::nullopt;
    const std::string& site = running->row.site;
    const auto* const station = result.station(site);
    if (station == nullptr || !station->u_gravity) return std::nullopt;

    Plan plan = visits_so_far(result.rows);
    const auto is_listed = [&](const Visit& visit) {
        return text::find_site(sites, visit.site) != nullptr;
    };
    const auto base = std::ranges::find_if(
        plan, [&](const Visit& visit) { return is_listed(visit) && is_known(sites, visit); });
    if (base == plan.end() || !std::ranges::all_of(plan, is_listed) || plan.back().site != site)
        return std::nullopt;
    PlannedUnit unit = usual_unit();
    unit.priors = model::day_priors_of(result.options.calibration);
    unit.noise = day->unit.noise;
    const double now_mgal = expected_mgal(plan, sites, unit, site);
    Visit back = plan.back();
    back.site = base->site;
    std::vector<double> drives = drives_s(plan);
    back.start = back.end() +
                 from_seconds(drives.empty() ? kUsualDrive_s : signal::median(std::move(drives)));
    plan.push_back(back);
    return expected_mgal(plan, sites, unit, site) / now_mgal * *station->u_gravity;
}

}  // namespace a351::corrector::design
