#include "daemon/survey/field_status.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "protocol/events/face.hpp"
#include "protocol/signal/median.hpp"
#include "protocol/signal/move_meaning.hpp"

namespace a351::daemon::survey {
namespace {

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

/// Where a stay is in its plan of faces.
struct Faces {
    int number = 1;  ///< Number of the running set-up in the plan: wrong faces before do not count.
    std::optional<int> first, face;  ///< Faces of the first and the running set-up, if known.
    bool is_on_its_side = false;     ///< The running set-up has no face.
    bool is_entered_wrong = false;   ///< Another face was entered than the data show.
    bool is_wrong = false;           ///< It does not count: another face than planned, or none.
    int planned = 1, next = 1;       ///< Planned faces of it and of the next one, 1 as the first.
};

/// Returns the medians of the axes while the box stood in a set-up, g; std::nullopt with less than a
/// minute of it.  Reason: *Next set-up* may come a minute before the box is lifted and turned.
std::optional<std::array<double, 3>> medians_g(const live::Record& live,
                                               const signal::EnteredSetUp& set_up) {
    constexpr std::size_t kFewest = 31;  // values of 2 s
    const auto samples = live.motion(std::max(set_up.start, set_up.end - kMoveMemory), set_up.end);
    const signal::StillPart part = signal::judge_moves(samples, set_up).part;
    std::array<double, 3> medians_g{};
    for (std::size_t axis = 0; axis < medians_g.size(); ++axis) {
        std::vector<double> values_g;
        for (std::size_t i = part.first; i < part.end; ++i)
            if (std::isfinite(samples[i].axes.at(axis).value()))
                values_g.push_back(to_standard_gravity(samples[i].axes.at(axis)).value());
        if (values_g.size() < kFewest) return std::nullopt;
        medians_g.at(axis) = signal::median(std::move(values_g));
    }
    return medians_g;
}

Faces faces_of(const Occupations& occupations, const live::Record& live,
               const std::vector<SetUp>& set_ups) {
    Faces faces;
    std::size_t vertical = 0;
    for (std::size_t k = 0; k < set_ups.size(); ++k) {
        if (k > 0 && !faces.is_wrong) ++faces.number;
        const std::optional<int> entered = occupations.running()->face_at(set_ups[k].start).entered;
        faces.planned = occupations.planned_face(faces.number);
        const auto stood_g =
            medians_g(live, {.start = set_ups[k].start,
                             .end = set_ups[k].end,
                             .ended_by = k + 1 < set_ups.size() ? signal::SetUpEnd::next_set_up
                                                                : signal::SetUpEnd::running,
                             .began_with_next_set_up = k > 0,
                             .not_moved_until = k + 1 < set_ups.size()
                                                    ? std::nullopt
                                                    : occupations.running()->not_moved_until});
        if (k == 0 && stood_g) vertical = events::vertical_axis(*stood_g);
        faces.face =
            stood_g ? events::face_of(StandardGravity(stood_g->at(vertical))) : std::nullopt;
        if (k == 0) faces.first = faces.face;
        faces.is_on_its_side = faces.first && stood_g && !faces.face;
        faces.is_entered_wrong = faces.face && entered && faces.face != entered;
        // An operator who says so may leave the plan.
        faces.is_wrong =
            faces.is_on_its_side || (faces.face && faces.first && faces.face != entered &&
                                     *faces.face != *faces.first * faces.planned);
    }
    faces.next = occupations.planned_face(faces.is_wrong ? faces.number : faces.number + 1);
    return faces;
}

/// Returns true if the box is to be turned over for the next set-up.
bool turns_next(const Faces& faces) {
    const bool is_seen = faces.is_wrong && faces.face && faces.first;
    return (is_seen ? *faces.face * *faces.first : faces.planned) != faces.next;
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

std::optional<PlannedStay> planned_stay(const Occupations& occupations, const live::Record& live,
                                        UtcTime at) {
    const auto& running = occupations.running();
    if (!running || at < running->start) return std::nullopt;
    auto set_ups = set_ups_so_far(*running, at);
    std::erase_if(set_ups, [at](const SetUp& one) { return one.start > at; });
    const SetUp last{set_ups.back().start, at};
    const double planned_s = std::chrono::duration<double>(occupations.planned()).count();
    const Faces faces = faces_of(occupations, live, set_ups);
    return PlannedStay{
        running->site,
        set_up_plan(occupations.planned_set_ups(), planned_s, faces.number,
                    seconds_between(running->start, at), seconds_between(last.start, at),
                    live.reading({&last, 1}).used_s),
        false, turns_next(faces)};
}

text::Message wrong_face(const Occupations& occupations, const live::Record& live, UtcTime now) {
    const auto& running = occupations.running();
    if (!running) return {};
    const Faces faces = faces_of(occupations, live, set_ups_so_far(*running, now));
    if (faces.is_on_its_side)
        return text::message("{}: set it down level and press Next set-up, or press Checked",
                             text::marked_message(events::kOnItsSide));
    if (faces.is_wrong)
        return text::message(
            "the box is not in the face that is planned for set-up {}: turn it over, set it down "
            "level and press Next set-up, or press Checked",
            faces.number);
    if (faces.is_entered_wrong)
        return text::message(
            "the box is in face {}, but face {} was entered: face {} is used; press Checked, or "
            "turn the box over and press Next set-up",
            events::sign_of(*faces.face), events::sign_of(-*faces.face),
            events::sign_of(*faces.face));
    return {};
}

std::optional<int> next_planned_face(const Occupations& occupations, const live::Record& live,
                                     UtcTime at) {
    const auto& running = occupations.running();
    if (!running || !occupations.has_planned_faces()) return std::nullopt;
    const Faces faces = faces_of(occupations, live, set_ups_so_far(*running, at));
    return faces.first ? std::optional(*faces.first * faces.next) : std::nullopt;
}

std::optional<MovePrompt> moved_box(const Occupations& occupations, const live::Record& live,
                                    UtcTime now) {
    const auto& running = occupations.running();
    if (!running) return std::nullopt;
    const SetUp last = set_ups_so_far(*running, now).back();
    auto moved = move_prompt(live.motion(std::max(last.start, now - kMoveMemory), now),
                             {.start = last.start,
                              .end = now,
                              .ended_by = signal::SetUpEnd::running,
                              .began_with_next_set_up = running->set_ups.size() > 1,
                              .not_moved_until = running->not_moved_until});
    // The start of a long set-up is not in the part that is looked at.
    if (moved && moved->is_at_start && now - last.start > kMoveMemory) moved.reset();
    return moved;
}

FieldStatus field_status(const Occupations& occupations, const live::Record& live, UtcTime now) {
    FieldStatus field;
    const auto& running = occupations.running();
    if (!running) {
        compare_level(field, occupations, live, now);
        return field;
    }
    const auto set_ups = set_ups_so_far(*running, now);
    const auto& last = set_ups.back();
    field.reading = live.reading({&last, 1});
    field.whole = live.reading(set_ups);
    // The clock may be behind the stay.
    field.stay = planned_stay(occupations, live, std::max(now, last.start));
    if (field.stay->plan.needs_next()) compare_level(field, occupations, live, now);
    constexpr double kLeastMissing_s = 1.0;  // A shorter gap changes no reading.
    if (const double missing_s = live.missing_s(last.start, now); missing_s >= kLeastMissing_s) {
        field.warnings.push_back(text::message("{:.0f} s are missing in this set-up", missing_s));
    }
    field.moved = moved_box(occupations, live, now);
    field.face = wrong_face(occupations, live, now);
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
