#include "daemon/survey/field_status.hpp"

#include <algorithm>
#include <limits>

namespace a351::daemon::survey {
namespace {

constexpr double kForgottenAfter = 3.0;  ///< Time until a reminder, in planned lengths.
/// A move is looked for in this time before now.  Reason: the search costs a millisecond for it.
constexpr Nanoseconds kMoveMemory = std::chrono::hours(2);

using SetUp = events::Occupation::SetUp;

std::vector<SetUp> set_ups_so_far(const events::RunningOccupation& running, UtcTime now) {
    std::vector<SetUp> set_ups;
    for (const UtcTime start : running.set_ups) {
        if (!set_ups.empty()) set_ups.back().end = start;
        set_ups.push_back({start, now});
    }
    return set_ups;
}

/// Returns warnings on the running stay.  A return to the first site of the day, the base, is none.
std::vector<text::Message> warnings_of(const events::RunningOccupation& running,
                                       const std::vector<events::Occupation>& day, double running_s,
                                       double planned_s) {
    std::vector<text::Message> warnings;
    if (std::ranges::count(day, running.site, &events::Occupation::site) > 0 &&
        running.site != day.front().site) {
        warnings.push_back(
            text::message("the site was occupied before: this is stay {}", running.number));
    }
    if (running_s > kForgottenAfter * planned_s) {
        warnings.push_back(text::message(
            "running for {:.0f} min, planned {:.0f} min: stop it if the reading is finished",
            running_s / 60.0, planned_s / 60.0));
    }
    return warnings;
}

void compare_level(FieldStatus& field, const Occupations& occupations, const live::Record& live,
                   UtcTime now) {
    const auto day = survey_day(occupations, now);
    const auto& running = occupations.running();
    if (day.empty() && !running) return;
    const SetUp first =
        day.empty() ? set_ups_so_far(*running, now).front() : day.front().set_ups.front();
    field.level_site = day.empty() ? running->site : day.front().site;
    field.level_utc = first.start;
    field.level = live.level_against(first.start, first.end);
}

}  // namespace

std::vector<events::Occupation> survey_day(const Occupations& occupations, UtcTime now) {
    const auto& running = occupations.running();
    return events::survey_day(occupations.list(), running ? running->start : now);
}

SetUpPlan set_up_plan(int planned, double length_s, int running, double stay_s, double set_up_s) {
    SetUpPlan plan{.running = running, .planned = planned};
    const double left_s = running > planned ? length_s - stay_s : length_s / planned - set_up_s;
    plan.left_s = std::max(0.0, left_s);
    const bool is_over = plan.left_s == 0.0;
    plan.may_stop = running >= planned && is_over;
    plan.proposes_next =
        planned == 1 ? running == 1 && stay_s >= 0.5 * length_s : running < planned && is_over;
    return plan;
}

FieldStatus field_status(const Occupations& occupations, const live::Record& live, UtcTime now) {
    FieldStatus field;
    compare_level(field, occupations, live, now);
    const auto& running = occupations.running();
    if (!running) return field;

    const auto set_ups = set_ups_so_far(*running, now);
    const auto& last = set_ups.back();
    field.reading = live.reading({&last, 1}, occupations.target());
    field.whole = live.reading(set_ups, occupations.target());
    const double running_s = seconds_between(running->start, now);
    const double planned_s = std::chrono::duration<double>(occupations.planned()).count();
    field.plan =
        set_up_plan(occupations.planned_set_ups(), planned_s, static_cast<int>(set_ups.size()),
                    running_s, seconds_between(last.start, now));
    if (field.plan.running < field.plan.planned) {
        field.whole.is_good_enough = false;
        field.whole.needed_s.reset();
    }
    field.warnings = warnings_of(*running, survey_day(occupations, now), running_s, planned_s);
    constexpr double kLeastMissing_s = 1.0;  // A shorter gap changes no reading.
    if (const double missing_s = live.missing_s(last.start, now); missing_s >= kLeastMissing_s) {
        field.warnings.push_back(text::message("{:.0f} s are missing in this set-up", missing_s));
    }
    field.moved = move_prompt(live.motion(std::max(last.start, now - kMoveMemory), now),
                              running->not_moved_until);
    // The start of a long set-up is not in the part that is looked at.
    if (field.moved && field.moved->is_at_start && now - last.start > kMoveMemory)
        field.moved.reset();
    if (field.moved) field.warnings.push_back(text_of(*field.moved));
    return field;
}

std::vector<SiteDistance> nearest_first(const std::vector<text::Site>& sites, Degrees latitude,
                                        Degrees longitude) {
    std::vector<SiteDistance> list;
    for (const text::Site& site : sites) {
        list.push_back({site, std::nullopt});
        if (site.is_placed) list.back().distance = distance(site, latitude, longitude);
    }
    std::ranges::stable_sort(list, {}, [](const SiteDistance& one) {
        return one.distance ? one.distance->value() : std::numeric_limits<double>::infinity();
    });
    return list;
}

}  // namespace a351::daemon::survey
