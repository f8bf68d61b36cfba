#include "corrector/design/alternatives.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "corrector/design/expected_errors.hpp"
#include "protocol/core/units.hpp"
#include "protocol/signal/median.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::design {
namespace {

/// Shortest set-up that is proposed, min: two complete means of 50 s between the disturbances.
constexpr double kShortestHalf_min = 3.0;
constexpr std::size_t kMostNewStations = 3;

/// A change in words, and the plan after it.
struct Change {
    std::string text;
    Plan plan;
    double least_gain = kLeastGain;
};

const text::Site& site_of(const std::vector<text::Site>& sites, const Visit& visit) {
    return *text::find_site(sites, visit.site);
}

/// Delays a visit and all later ones.
void delay(Plan& plan, std::size_t first, double minutes) {
    // Whole seconds, so that the changed plan reads well.
    const auto later = std::chrono::seconds(std::lround(60.0 * minutes));
    for (std::size_t i = first; i < plan.size(); ++i) plan[i].start += later;
}

/// Changes visits one by one; each change of the duration delays the later ones.
Plan with_visits(Plan plan, const std::function<void(Visit&)>& change) {
    for (std::size_t i = 0; i < plan.size(); ++i) {
        const double before = plan[i].minutes();
        change(plan[i]);
        delay(plan, i + 1, plan[i].minutes() - before);
    }
    return plan;
}

/// Adds a visit after another one.
Plan with_visit_after(Plan plan, std::size_t after, const std::string& site) {
    const double drive_s = signal::median(drives_s(plan));
    Visit visit = plan[after];
    visit.site = site;
    visit.start = visit.end() + from_seconds(drive_s);
    const auto place = plan.begin() + static_cast<std::ptrdiff_t>(after) + 1;
    plan.insert(place, visit);
    delay(plan, after + 2, drive_s / kSecondsPerMinute + visit.minutes());
    return plan;
}

/// Returns the visit after which half of the time of the day has passed; never the last one.
std::size_t middle_of(const Plan& plan) {
    const UtcTime middle = plan.front().start + (plan.back().end() - plan.front().start) / 2;
    std::size_t last = 0;
    while (last + 2 < plan.size() && plan[last + 1].end() <= middle) ++last;
    return last;
}

Plan with_way_back(Plan plan) {
    const Plan there = plan;
    for (std::size_t i = there.size(); i-- > 0;) {
        Visit visit = there[i];
        // On the way back each drive takes as long as on the way out; the first one is a pause.
        const auto drive =
            i + 1 < there.size() ? there[i + 1].start - there[i].end() : Nanoseconds(0);
        visit.start = plan.back().end() + drive;
        plan.push_back(visit);
    }
    return plan;
}

/// A known station that is not visited, and the visit nearest to it.
struct NewStation {
    std::string site;
    std::size_t after = 0;
    Metres distance;
};

std::vector<NewStation> nearest_new_stations(const Plan& plan,
                                             const std::vector<text::Site>& sites) {
    std::vector<NewStation> found;
    for (const text::Site& site : sites) {
        if (!site.gravity || !site.is_placed) continue;
        if (std::ranges::find(plan, site.name, &Visit::site) != plan.end()) continue;
        NewStation station{site.name, 0, Metres(HUGE_VAL)};
        for (std::size_t i = 0; i < plan.size(); ++i) {
            const text::Site& visited = site_of(sites, plan[i]);
            const Metres distance = text::distance(site, visited.latitude, visited.longitude);
            if (distance < station.distance) station = {site.name, i, distance};
        }
        found.push_back(std::move(station));
    }
    std::ranges::stable_sort(found, {}, &NewStation::distance);
    found.resize(std::min(found.size(), kMostNewStations));
    return found;
}

/// Returns the plan of the same minutes with the box turned over: its set-ups in the faces + - - +, a
/// single one cut into four or two that are long enough.  Empty if it cannot be cut.
Plan turned(const Plan& plan) {
    Plan all = plan;
    for (Visit& visit : all) {
        const int parts = visit.set_ups > 1                               ? 1
                          : visit.minutes_each >= 4.0 * kShortestHalf_min ? 4
                                                                          : 2;
        visit.set_ups *= parts;
        visit.minutes_each /= parts;
        if (visit.minutes_each < kShortestHalf_min && parts > 1) return {};
        visit.faces.clear();
        for (int k = 0; k < visit.set_ups; ++k) visit.faces += "+--+"[k % 4];
    }
    return all;
}

/// Returns the plan without turning, or with it.
std::optional<Change> change_of_faces(const Plan& plan) {
    if (is_turned(plan))
        return Change{"the same set-ups in one face",
                      with_visits(plan, [](Visit& visit) { visit.faces.assign(1, '+'); })};
    Plan faces = turned(plan);
    if (faces.empty()) return std::nullopt;
    const bool is_cut = std::ranges::any_of(plan, [](const Visit& v) { return v.set_ups == 1; });
    return Change{fmt::format("turning the box over between the set-ups{}",
                              is_cut ? ", single ones cut into two or four" : ""),
                  std::move(faces), kLeastGainOfTurning};
}

/// Adds a set-up in the face of the last one.
void one_more(Visit& visit) {
    if (visit.faces.size() > 1) visit.faces += visit.faces.back();
    ++visit.set_ups;
}

std::vector<Change> changes_of(const Plan& plan, const std::vector<text::Site>& sites) {
    std::vector<Change> changes;
    const auto all = [&plan](const auto& condition) {
        return std::ranges::all_of(plan, condition);
    };
    if (auto faces = change_of_faces(plan)) changes.push_back(std::move(*faces));
    if (all([](const Visit& visit) {
            return visit.minutes_each >= 2.0 * kShortestHalf_min &&
                   2 * visit.set_ups <= kMostSetUps;
        })) {
        const bool is_one = all([](const Visit& visit) { return visit.set_ups == 1; });
        changes.push_back({is_one ? "two set-ups of half the length at each visit"
                                  : "twice as many set-ups of half the length at each visit",
                           with_visits(plan, [](Visit& visit) {
                               visit.set_ups *= 2;
                               visit.minutes_each /= 2.0;
                               if (visit.faces.size() > 1) visit.faces += visit.faces;
                           })});
    }
    if (all([](const Visit& visit) { return visit.set_ups < kMostSetUps; })) {
        changes.push_back({"one more set-up at each visit", with_visits(plan, one_more)});
        changes.push_back({"one more set-up at each visit of a known station",
                           with_visits(plan, [&sites](Visit& visit) {
                               if (is_known(sites, visit)) one_more(visit);
                           })});
    }
    if (all([](const Visit& visit) { return 2.0 * visit.minutes_each <= kMostMinutes; }))
        changes.push_back({"set-ups twice as long",
                           with_visits(plan, [](Visit& visit) { visit.minutes_each *= 2.0; })});
    const auto base =
        std::ranges::find_if(plan, [&sites](const Visit& visit) { return is_known(sites, visit); });
    if (!is_known(sites, plan.back()))
        changes.push_back({fmt::format("a return to {} at the end", base->site),
                           with_visit_after(plan, plan.size() - 1, base->site)});
    const std::size_t middle = middle_of(plan);
    if (plan[middle].site != base->site && plan[middle + 1].site != base->site)
        changes.push_back(
            {fmt::format("a return to {} in the middle, after {}", base->site, plan[middle].site),
             with_visit_after(plan, middle, base->site)});
    for (const NewStation& station : nearest_new_stations(plan, sites))
        changes.push_back({fmt::format("{}, which is known too, after {}", station.site,
                                       plan[station.after].site),
                           with_visit_after(plan, station.after, station.site)});
    changes.push_back({"all visits once more in reverse order", with_way_back(plan)});
    return changes;
}

}  // namespace

std::vector<Alternative> alternatives(const Plan& plan, const std::vector<text::Site>& sites,
                                      const PlannedUnit& unit, MilliGal u) {
    std::vector<Alternative> found;
    for (Change& change : changes_of(plan, sites)) {
        const MilliGal changed =
            expected_errors(change.plan, sites, unit, Detail::stations).u_unknown;
        if (changed.value() > (1.0 - change.least_gain) * u.value()) continue;
        const double extra_minutes = 60.0 * (duration_h(change.plan) - duration_h(plan));
        found.push_back({fmt::format("{}: {} instead of {} mGal, {}", change.text,
                                     text::fixed(changed.value(), 2), text::fixed(u.value(), 2),
                                     std::lround(extra_minutes) == 0
                                         ? "in the same time"
                                         : text::fixed(extra_minutes, 0) + " min more"),
                         std::move(change.plan), changed, extra_minutes});
    }
    std::ranges::stable_sort(found, {}, &Alternative::u);
    return found;
}

}  // namespace a351::corrector::design
