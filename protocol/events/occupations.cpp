#include <algorithm>
#include <utility>

#include "protocol/events/event_log.hpp"

namespace a351::record {

namespace {

std::string detail(const Event& event, const std::string& key) {
    const auto found = event.details.find(key);
    return found == event.details.end() ? std::string() : found->second;
}

void remark(Occupation& occupation, const Event& event) {
    const std::string note = detail(event, "note");
    if (note.empty()) return;
    if (!occupation.note.empty()) occupation.note += "; ";
    occupation.note += note;
}

/// Applies the events one by one.
class EventReplay {
public:
    explicit EventReplay(const std::vector<Event>& events) {
        for (const Event& event : events) take(event);
    }

    [[nodiscard]] std::vector<Occupation> take_finished() { return std::move(finished_); }
    [[nodiscard]] std::optional<std::string> running_site() const {
        return is_running_ ? std::optional(running_.site) : std::nullopt;
    }

private:
    void take(const Event& event) {
        if (event.type == "start") start(event);
        if (event.type == "rename") rename(event);
        if (event.type == "discard") discard();
        if (!is_running_) return;
        if (event.type == "setup") begin_set_up(event.utc);
        if (event.type == "note") remark(running_, event);
        if (event.type == "stop") {
            remark(running_, event);
            stop(event.utc);
        }
    }

    void start(const Event& event) {
        if (is_running_) stop(event.utc);
        is_running_ = true;
        running_ = Occupation{};
        running_.site = detail(event, "site");
        remark(running_, event);
        set_up_ = event.utc;
    }

    void begin_set_up(UtcTime time) {
        if (time != set_up_) running_.set_ups.push_back({set_up_, time});
        set_up_ = time;
    }

    void stop(UtcTime end) {
        begin_set_up(end);
        if (!running_.set_ups.empty()) finished_.push_back(running_);
        is_running_ = false;
    }

    void rename(const Event& event) {
        if (!is_running_ && finished_.empty()) return;
        Occupation& occupation = is_running_ ? running_ : finished_.back();
        occupation.site = detail(event, "site");
        remark(occupation, event);
    }

    void discard() {
        if (is_running_) {
            is_running_ = false;
        } else if (!finished_.empty()) {
            finished_.pop_back();
        }
    }

    bool is_running_ = false;
    Occupation running_;
    UtcTime set_up_;
    std::vector<Occupation> finished_;
};

}  // namespace

std::vector<Occupation> occupations_of(const std::vector<Event>& events) {
    auto occupations = EventReplay(events).take_finished();
    std::ranges::stable_sort(occupations, {},
                             [](const Occupation& one) { return one.set_ups.front().start; });
    std::map<std::string, int> stays;
    for (Occupation& occupation : occupations) occupation.number = ++stays[occupation.site];
    return occupations;
}

std::vector<Occupation> survey_day(std::vector<Occupation> occupations, UtcTime later) {
    auto first = occupations.end();
    while (first != occupations.begin() &&
           later - std::prev(first)->set_ups.back().start < kSurveyNight) {
        --first;
        later = first->set_ups.front().start;
    }
    occupations.erase(occupations.begin(), first);
    return occupations;
}

std::optional<std::string> running_site(const std::vector<Event>& events) {
    return EventReplay(events).running_site();
}

}  // namespace a351::record
