#include "protocol/events/occupations.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "protocol/core/whole_number.hpp"
#include "protocol/text/plain_text.hpp"

namespace a351::events {

namespace {

constexpr const char* kKey = "key";

UtcTime start_of(const Occupation& occupation) { return occupation.set_ups.front().start; }

/// Returns the name of the site in the form of the list of sites, so that stays are counted right.
std::string site_of(const Event& event) { return text::plain_text(event.detail("site")); }

void add_text(std::string& notes, const std::string& text) {
    if (text.empty()) return;
    if (!notes.empty()) notes += "; ";
    notes += text;
}

void add_note(std::string& notes, const Event& event) { add_text(notes, event.detail("note")); }

StatedFace face_of(const Event& event) {
    return {parse_face(event.detail("face")), parse_face(event.detail("planned_face"))};
}

/// Returns the set-ups of a stay between these limits, without those of no duration.
std::vector<Occupation::SetUp> set_ups_of(const RunningOccupation& stay,
                                          const std::vector<UtcTime>& starts, UtcTime end) {
    std::vector<Occupation::SetUp> set_ups;
    for (std::size_t i = 0; i < starts.size(); ++i) {
        const UtcTime next = i + 1 < starts.size() ? starts[i + 1] : end;
        if (starts[i] != next) set_ups.push_back({starts[i], next, stay.face_at(starts[i])});
    }
    return set_ups;
}

/// Returns the starts of the set-ups of a stay that begins at `from` and ends at `end`.
std::vector<UtcTime> starts_within(const std::vector<UtcTime>& logged, UtcTime from, UtcTime end) {
    std::vector<UtcTime> starts{from};
    for (std::size_t i = 1; i < logged.size(); ++i)
        if (logged[i] > from && logged[i] < end) starts.push_back(logged[i]);
    return starts;
}

void move_start(RunningOccupation& stay, std::vector<UtcTime> starts) {
    stay.start = starts.front();
    stay.set_ups = std::move(starts);
    stay.session.reset();
    stay.index.reset();
}

}  // namespace

StatedFace RunningOccupation::face_at(UtcTime time) const {
    if (faces.empty()) return {};
    const auto after = faces.upper_bound(time);
    return (after == faces.begin() ? after : std::prev(after))->second;
}

std::optional<int> parse_planned_set_ups(std::string_view text) noexcept {
    const auto count = parse_whole<int>(text);
    return count && is_planned_set_ups(*count) ? count : std::nullopt;
}

void OccupationReplay::take(const Event& event) {
    apply(event);
    renumber();
}

void OccupationReplay::apply(const Event& event) {
    if (event.type == "start") start(event);
    if (event.type == "rename") rename(event);
    if (event.type == "discard") discard(event);
    if (event.type == "resume") resume(event);
    if (event.type == "retime") retime(event);
    if (event.type == "restore" && !event.detail(kKey).empty())
        if (Ended* const ended = ended_of(event)) ended->is_discarded = false;
    if (event.type == "not_moved" && !event.detail(kKey).empty())
        if (RunningOccupation* const stay = stay_of(event)) stay->not_moved_until = event.utc;
    if (event.type == "note") {
        RunningOccupation* const stay = !event.detail(kKey).empty() ? stay_of(event)
                                        : running_                  ? &*running_
                                                                    : nullptr;
        if (stay) add_note(stay->note, event);
    }
    if (!running_) return;
    // A stay that began after the last sample of the sensor before is one of the new sensor.
    if (event.type == "other_unit" && event.utc > running_->start) {
        add_text(running_->note, "another sensor: " + event.detail("serial_number") + " after " +
                                     event.detail("before"));
        return end_running(std::max(event.utc, running_->set_ups.back()), true);
    }
    if (event.type == "setup") {
        running_->set_ups.push_back(event.utc);
        running_->faces[event.utc] = face_of(event);
    }
    if (event.type == "stop") {
        const std::string site = site_of(event);
        if (!site.empty() && site != running_->site)
            add_text(running_->note, "its stop names " + site);
        add_note(running_->note, event);
        end_running(event.utc, true);
    }
}

std::string OccupationReplay::key_for(UtcTime start) const {
    while (true) {
        if (std::string key = to_compact(start); !keys_.contains(key)) return key;
        start += std::chrono::seconds(1);
    }
}

void OccupationReplay::start(const Event& event) {
    if (running_) end_running(event.utc, false);
    std::string key = event.detail(kKey);
    if (key.empty() || keys_.contains(key)) key = key_for(event.utc);
    keys_.insert(key);
    running_ = RunningOccupation{.key = key,
                                 .site = site_of(event),
                                 .start = event.utc,
                                 .set_ups = {event.utc},
                                 .faces = {{event.utc, face_of(event)}},
                                 .session = event.session,
                                 .index = event.index,
                                 .operator_name = event.detail("operator"),
                                 .note = {}};
    add_note(running_->note, event);
    running_->planned_set_ups = parse_planned_set_ups(event.detail("set_ups"));
}

void OccupationReplay::end_running(UtcTime end, bool is_stopped) {
    Ended ended{*std::move(running_), end, is_stopped};
    running_.reset();
    if (!set_ups_of(ended.stay, ended.stay.set_ups, end).empty())
        ended_.push_back(std::move(ended));
}

/// Returns the ended stay that the event's key names; without a key, the last one that was not
/// discarded.
OccupationReplay::Ended* OccupationReplay::ended_of(const Event& event) {
    const std::string key = event.detail(kKey);
    const auto found = std::find_if(ended_.rbegin(), ended_.rend(), [&](const Ended& one) {
        return key.empty() ? !one.is_discarded : one.stay.key == key;
    });
    return found == ended_.rend() ? nullptr : &*found;
}

/// Returns the stay that the event's key names; without a key, the running or else the last one.
RunningOccupation* OccupationReplay::stay_of(const Event& event) {
    const std::string key = event.detail(kKey);
    if (running_ && (key.empty() || key == running_->key)) return &*running_;
    Ended* const ended = ended_of(event);
    return ended ? &ended->stay : nullptr;
}

void OccupationReplay::rename(const Event& event) {
    RunningOccupation* const stay = stay_of(event);
    if (!stay) return;
    stay->site = site_of(event);
    add_note(stay->note, event);
}

void OccupationReplay::discard(const Event& event) {
    const std::string key = event.detail(kKey);
    if (running_ && (key.empty() || key == running_->key)) {
        const std::size_t before = ended_.size();
        end_running(event.utc, true);
        if (ended_.size() > before) ended_.back().is_discarded = true;
    } else if (Ended* const ended = ended_of(event)) {
        ended->is_discarded = true;
    }
}

void OccupationReplay::resume(const Event& event) {
    if (running_ || event.detail(kKey).empty()) return;
    Ended* const ended = ended_of(event);
    if (!ended || ended->is_discarded) return;
    std::vector<UtcTime> starts = starts_of(*ended);
    const bool is_moved = ended->from.has_value();
    running_ = std::move(ended->stay);
    if (is_moved) move_start(*running_, std::move(starts));
    ended_.erase(ended_.begin() + (ended - ended_.data()));
}

void OccupationReplay::retime(const Event& event) {
    if (event.detail(kKey).empty()) return;
    const auto from = parse_rfc3339(event.detail("from")), to = parse_rfc3339(event.detail("to"));
    if (running_ && running_->key == event.detail(kKey)) {
        if (from) move_start(*running_, starts_within(running_->set_ups, *from, UtcTime::max()));
    } else if (Ended* const ended = ended_of(event)) {
        ended->is_stopped = ended->is_stopped || to;
        ended->end = to.value_or(ended->end);
        ended->from = from.value_or(ended->from.value_or(ended->stay.start));
        ended->stay.start = *ended->from;
    }
}

/// Returns the starts of the set-ups.  All that were logged are kept, so that a stay can be made
/// longer again.
std::vector<UtcTime> OccupationReplay::starts_of(const Ended& ended) {
    const std::vector<UtcTime>& logged = ended.stay.set_ups;
    return ended.from ? starts_within(logged, *ended.from, ended.end) : logged;
}

void OccupationReplay::renumber() {
    std::vector<RunningOccupation*> by_start;
    for (Ended& one : ended_)
        if (!one.is_discarded && !set_ups_of(one.stay, starts_of(one), one.end).empty())
            by_start.push_back(&one.stay);
    std::ranges::stable_sort(by_start, {}, [](const RunningOccupation* one) { return one->start; });
    std::map<std::string, int> stays;
    for (RunningOccupation* const stay : by_start) stay->number = ++stays[stay->site];
    if (running_) running_->number = 1 + stays[running_->site];
}

std::vector<Occupation> OccupationReplay::stays(bool are_discarded) const {
    std::vector<Occupation> occupations;
    for (const Ended& one : ended_) {
        auto set_ups = set_ups_of(one.stay, starts_of(one), one.end);
        if (one.is_discarded != are_discarded || set_ups.empty()) continue;
        occupations.push_back({one.stay.key, one.stay.site, one.stay.number, std::move(set_ups),
                               one.stay.note, one.is_stopped, one.stay.not_moved_until,
                               one.stay.operator_name});
    }
    std::ranges::stable_sort(occupations, {}, start_of);
    return occupations;
}

std::vector<Occupation> OccupationReplay::finished() const { return stays(false); }

std::vector<Occupation> OccupationReplay::discarded() const { return stays(true); }

std::vector<Occupation> survey_day(std::vector<Occupation> occupations, UtcTime later) {
    auto first = occupations.end();
    while (first != occupations.begin() &&
           later - std::prev(first)->set_ups.back().start < kSurveyNight) {
        --first;
        later = start_of(*first);
    }
    occupations.erase(occupations.begin(), first);
    return occupations;
}

}  // namespace a351::events
