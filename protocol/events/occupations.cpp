#include "protocol/events/occupations.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace a351::events {

namespace {

UtcTime start_of(const Occupation& occupation) { return occupation.set_ups.front().start; }

std::string detail(const Event& event, const std::string& key) {
    const auto found = event.details.find(key);
    return found == event.details.end() ? std::string() : found->second;
}

void add_note(std::string& notes, const Event& event) {
    const std::string note = detail(event, "note");
    if (note.empty()) return;
    if (!notes.empty()) notes += "; ";
    notes += note;
}

}  // namespace

void OccupationReplay::take(const Event& event) {
    apply(event);
    renumber();
}

void OccupationReplay::apply(const Event& event) {
    if (event.type == "start") start(event);
    if (event.type == "rename") rename(event);
    if (event.type == "discard") discard();
    if (running_) {
        if (event.type == "setup") running_->set_ups.push_back(event.utc);
        if (event.type == "note" || event.type == "stop") add_note(running_->note, event);
        if (event.type == "stop") end_running(event.utc, true);
    }
}

void OccupationReplay::start(const Event& event) {
    if (running_) end_running(event.utc, false);
    running_ = RunningOccupation{
        detail(event, "site"),     1, event.utc, {event.utc}, event.session, event.index,
        detail(event, "operator"), ""};
    add_note(running_->note, event);
}

void OccupationReplay::end_running(UtcTime end, bool is_stopped) {
    Occupation ended{running_->site, 1, {}, running_->note, is_stopped};
    std::vector<UtcTime>& limits = running_->set_ups;
    limits.push_back(end);
    for (std::size_t i = 1; i < limits.size(); ++i)
        if (limits[i] != limits[i - 1]) ended.set_ups.push_back({limits[i - 1], limits[i]});
    if (!ended.set_ups.empty()) ended_.push_back(std::move(ended));
    running_.reset();
}

void OccupationReplay::rename(const Event& event) {
    if (running_) {
        running_->site = detail(event, "site");
        add_note(running_->note, event);
    } else if (!ended_.empty()) {
        ended_.back().site = detail(event, "site");
        add_note(ended_.back().note, event);
    }
}

void OccupationReplay::discard() {
    if (running_)
        running_.reset();
    else if (!ended_.empty())
        ended_.pop_back();
}

void OccupationReplay::renumber() {
    std::vector<Occupation*> by_start;
    for (Occupation& occupation : ended_) by_start.push_back(&occupation);
    std::ranges::stable_sort(by_start, {}, [](const Occupation* one) { return start_of(*one); });
    std::map<std::string, int> stays;
    for (Occupation* const occupation : by_start) occupation->number = ++stays[occupation->site];
    if (running_) running_->number = 1 + stays[running_->site];
}

std::vector<Occupation> OccupationReplay::finished() const {
    std::vector<Occupation> occupations = ended_;
    std::ranges::stable_sort(occupations, {}, start_of);
    return occupations;
}

std::optional<Occupation> OccupationReplay::last_finished() const {
    return ended_.empty() ? std::nullopt : std::optional(ended_.back());
}

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
