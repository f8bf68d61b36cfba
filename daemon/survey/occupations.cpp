#include "daemon/survey/occupations.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <system_error>
#include <utility>

namespace a351::daemon {
namespace {

std::string shown(UtcTime time) { return to_rfc3339(time, 1); }

Outcome refused(std::string message) { return {Outcome::Kind::refused, std::move(message)}; }

record::Event event_at(std::string type, const Instant& instant) {
    record::Event event;
    event.type = std::move(type);
    event.utc = instant.utc;
    event.session = instant.session;
    event.index = instant.index;
    return event;
}

void add(record::Event& event, const std::string& key, std::string_view text) {
    if (!text.empty()) event.details[key] = text;
}

void add(record::Event& event, const Remark& remark) {
    add(event, "operator", remark.operator_name);
    add(event, "note", remark.note);
}

std::string detail(const record::Event& event, const std::string& key) {
    const auto found = event.details.find(key);
    return found == event.details.end() ? "" : found->second;
}

constexpr const char* kTargetKey = "target_mgal";

bool is_target(MilliGal target) { return target.value() >= 0.01 && target.value() <= 1000.0; }

std::optional<MilliGal> target_of(const record::Event& event) {
    const std::string text = detail(event, kTargetKey);
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return is_target(MilliGal(value)) ? std::optional(MilliGal(value)) : std::nullopt;
}

std::string named(std::string_view site, int number) {
    return std::string(site) + " (stay " + std::to_string(number) + ")";
}

std::string named(const record::Occupation& occupation) {
    return named(occupation.site, occupation.number);
}

}  // namespace

Occupations::Occupations(Recorder& recorder, std::vector<text::Site> sites,
                         std::vector<record::Event> events, const Options& options)
    : recorder_(recorder), options_(options), sites_(std::move(sites)) {
    events_.reserve(events.size());
    for (auto& event : events) {
        follow(event);
        events_.push_back(std::move(event));
    }
    renumber();
}

Occupations::Placed Occupations::place(std::optional<UtcTime> at) {
    const auto latest = recorder_.latest();
    if (!latest) return {std::nullopt, "no sample is available yet; see the status"};
    if (!at) return {latest, ""};
    if (*at > latest->utc) {
        return {std::nullopt, shown(*at) + " is later than the last sample, " + shown(latest->utc)};
    }
    auto placed = recorder_.at(*at);
    if (placed) return {placed, ""};
    return {std::nullopt, shown(*at) + " is earlier than the data that the daemon keeps in memory"};
}

std::optional<std::string> Occupations::trouble_with_site(std::string_view site) const {
    if (site.empty()) return "no site is given";
    if (sites_.empty() || text::find_site(sites_, site)) return std::nullopt;
    return "site " + std::string(site) + " is not one of the " + std::to_string(sites_.size()) +
           " sites in the list";
}

/// Makes an event that needs no sample, because it must be possible with the sensor unplugged.
record::Event Occupations::about_now(std::string type) {
    if (const auto latest = recorder_.latest()) return event_at(std::move(type), *latest);
    record::Event event;
    event.type = std::move(type);
    if (!events_.empty()) event.utc = events_.back().utc;
    return event;
}

Outcome Occupations::start(std::string_view site, const Remark& remark, std::optional<UtcTime> at) {
    if (running_) {
        return refused(named(running_->site, running_->number) + " has been running since " +
                       shown(running_->start) + ": stop or discard it first");
    }
    if (auto trouble = trouble_with_site(site)) return refused(*std::move(trouble));
    const auto placed = place(at);
    if (!placed.instant) return refused(placed.trouble);
    for (const auto& one : list()) {
        if (one.set_ups.front().start <= placed.instant->utc &&
            placed.instant->utc < one.set_ups.back().end) {
            return refused(shown(placed.instant->utc) + " is within the occupation " + named(one) +
                           ", " + shown(one.set_ups.front().start) + " to " +
                           shown(one.set_ups.back().end));
        }
    }
    auto event = event_at("start", *placed.instant);
    add(event, "site", site);
    add(event, remark);
    auto outcome = commit(std::move(event),
                          "started " + std::string(site) + " at " + shown(placed.instant->utc));
    if (running_ && running_->number > 1)
        outcome.message +=
            "; the site was occupied before: stay " + std::to_string(running_->number);
    return outcome;
}

Outcome Occupations::stop(const Remark& remark, std::optional<UtcTime> at) {
    if (!running_) return refused("no occupation is running");
    const auto placed = place(at);
    if (!placed.instant) return refused(placed.trouble);
    if (placed.instant->utc <= running_->set_ups.back()) {
        return refused(shown(placed.instant->utc) + " is not after the start of the set-up at " +
                       running_->site + ", " + shown(running_->set_ups.back()));
    }
    for (const auto& one : list()) {
        const auto begin = one.set_ups.front().start;
        if (running_->start < begin && begin < placed.instant->utc) {
            return refused(named(one) + " lies between the start at " + running_->site + " and " +
                           shown(placed.instant->utc));
        }
    }
    auto event = event_at("stop", *placed.instant);
    add(event, "site", running_->site);
    add(event, remark);
    return commit(std::move(event), "stopped " + named(running_->site, running_->number) + " at " +
                                        shown(placed.instant->utc) +
                                        remarks_on_stop(placed.instant->utc));
}

std::string Occupations::remarks_on_stop(UtcTime stop) const {
    const Nanoseconds stay = stop - running_->start;
    if (stay >= options_.planned) return "";
    char text[80];
    const auto minutes = [](Nanoseconds span) {
        return std::chrono::duration<double, std::ratio<60>>(span).count();
    };
    std::snprintf(text, sizeof text, "; shorter than planned: %.1f of %.0f min", minutes(stay),
                  minutes(options_.planned));
    return text;
}

Outcome Occupations::setup(std::optional<UtcTime> at) {
    if (!running_) return refused("no occupation is running");
    const auto placed = place(at);
    if (!placed.instant) return refused(placed.trouble);
    if (placed.instant->utc <= running_->set_ups.back()) {
        return refused(shown(placed.instant->utc) + " is not after the start of the set-up at " +
                       running_->site + ", " + shown(running_->set_ups.back()));
    }
    auto event = event_at("setup", *placed.instant);
    add(event, "site", running_->site);
    return commit(std::move(event), "further set-up at " + named(running_->site, running_->number) +
                                        " from " + shown(placed.instant->utc));
}

Outcome Occupations::discard() {
    auto event = about_now("discard");
    if (running_) {
        add(event, "site", running_->site);
        return commit(std::move(event), "discarded " + named(running_->site, running_->number) +
                                            ", which was running");
    }
    const auto last = changed_by(event);
    if (!last) return refused("there is no occupation to discard");
    add(event, "site", last->site);
    return commit(std::move(event),
                  "discarded " + named(*last) + ", started " + shown(last->set_ups.front().start));
}

Outcome Occupations::rename(std::string_view site, const Remark& remark) {
    if (auto trouble = trouble_with_site(site)) return refused(*std::move(trouble));
    auto event = about_now("rename");
    add(event, "site", site);
    add(event, remark);
    const auto last = changed_by(event);
    if (!running_ && !last) {
        return refused("there is no occupation to rename, or " + std::string(site) +
                       " is already its name");
    }
    std::string old = running_ ? named(running_->site, running_->number) : named(*last);
    return commit(std::move(event), "renamed " + std::move(old) + " to " + std::string(site));
}

Outcome Occupations::note(std::string_view text) {
    if (text.empty()) return refused("the note is empty");
    auto event = about_now("note");
    if (event.utc == UtcTime{}) return refused("no sample is available yet; see the status");
    add(event, "note", text);
    std::string said = "noted at " + shown(event.utc);
    return commit(std::move(event), std::move(said));
}

Outcome Occupations::set_target(MilliGal target) {
    if (!is_target(target)) return refused("target: allowed: 0.01 to 1000 mGal");
    auto event = about_now("target");
    if (event.utc == UtcTime{}) return refused("no sample is available yet; see the status");
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.begin(), text.end(), target.value()).ptr;
    add(event, kTargetKey, std::string_view(text.data(), end));
    return commit(std::move(event), "target set: good enough at a standard error of " +
                                        std::string(text.data(), end) + " mGal");
}

void Occupations::use(std::vector<text::Site> sites, const Options& options) {
    sites_ = std::move(sites);
    options_ = options;
}

std::vector<record::Occupation> Occupations::list() const {
    return record::occupations_of(events_);
}

/// Returns the finished occupation that `event` would remove or rename.
std::optional<record::Occupation> Occupations::changed_by(const record::Event& event) const {
    auto events = events_;
    events.push_back(event);
    const auto after = record::occupations_of(events);
    for (const auto& one : list()) {
        const bool is_unchanged = std::any_of(after.begin(), after.end(), [&](const auto& other) {
            return other.site == one.site &&
                   other.set_ups.front().start == one.set_ups.front().start;
        });
        if (!is_unchanged) return one;
    }
    return std::nullopt;
}

Outcome Occupations::commit(record::Event event, std::string message) {
    try {
        recorder_.commit(event);
    } catch (const std::system_error& error) {
        return {Outcome::Kind::failed, std::string("not saved: ") + error.what()};
    }
    follow(event);
    events_.push_back(std::move(event));
    renumber();
    return {Outcome::Kind::done, std::move(message)};
}

void Occupations::follow(const record::Event& event) {
    if (event.type == "start") {
        running_ = RunningOccupation{detail(event, "site"),
                                     1,
                                     event.utc,
                                     {event.utc},
                                     event.session,
                                     event.index,
                                     {detail(event, "operator"), detail(event, "note")}};
    } else if (event.type == "target") {
        if (const auto target = target_of(event)) target_ = target;
    } else if (running_) {
        if (event.type == "stop" || event.type == "discard") running_.reset();
        if (event.type == "setup") running_->set_ups.push_back(event.utc);
        if (event.type == "rename") running_->site = detail(event, "site");
    }
}

void Occupations::renumber() {
    if (!running_) return;
    const auto finished = list();
    running_->number =
        1 + static_cast<int>(std::count_if(finished.begin(), finished.end(), [&](const auto& one) {
            return one.site == running_->site;
        }));
}

}  // namespace a351::daemon
