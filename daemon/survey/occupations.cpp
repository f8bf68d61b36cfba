#include "daemon/survey/occupations.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "daemon/survey/event_texts.hpp"
#include "daemon/survey/site_list.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/csv_reader.hpp"
#include "protocol/text/doubtful_site.hpp"
#include "protocol/text/plain_text.hpp"

namespace a351::daemon::survey {
namespace {

events::Event event_at(std::string type, const Instant& instant) {
    return {std::move(type), instant.utc, instant.session, instant.index, {}};
}

void add_face(events::Event& event, const events::StatedFace& face) {
    if (face.entered) add(event, "face", std::string(events::sign_of(*face.entered)));
    if (face.planned) add(event, "planned_face", std::string(events::sign_of(*face.planned)));
}

Outcome unchanged(text::Message message) { return {Outcome::Kind::done, std::move(message)}; }

}  // namespace

Occupations::Occupations(Recorder& recorder, std::vector<text::Site> sites,
                         const std::vector<events::Event>& events, const OccupationOptions& options)
    : recorder_(recorder), options_(options), replay_(events) {
    take(std::move(sites));
    for (const events::Event& event : events) note_aside(event);
}

/// Returns the time of a sample of the running stay that continues the time of its start; that of the
/// clock if the first sample of the stay is not known.
UtcTime Occupations::own_time(const Instant& sample) {
    std::optional<Instant> first;
    if (running()->session && running()->index)
        first = {*running()->session, *running()->index, running()->start};
    else
        first = recorder_.at(running()->start);
    if (!first) return sample.utc;
    return running()->start + recorder_.signal_since(first->session, first->index) -
           recorder_.signal_since(sample.session, sample.index);
}

/// Returns the sample with its own_time() if the clock is behind the last set-up of the running stay.
Instant Occupations::in_running(Instant sample) {
    if (running() && sample.utc + kLeastBack < running()->set_ups.back())
        sample.utc = own_time(sample);
    return sample;
}

std::optional<Instant> Occupations::newest() {
    const auto latest = recorder_.latest();
    return latest ? std::optional(in_running(*latest)) : std::nullopt;
}

/// Returns what is to be said if the clock was set back during the running stay: more signal came than
/// time passed.
text::Message Occupations::remark_on_clock() {
    constexpr int kPartOfRate = 9000;  // The sensor's rate is 110 ppm off at most.
    const auto latest = recorder_.latest();
    if (!latest) return {};
    const UtcTime own = own_time(*latest);
    if (own - latest->utc < kLeastBack + (own - running()->start) / kPartOfRate) return {};
    return text::message(
        "; the clock was set back during this stay: set it, and correct the times later with "
        "a351-correct retime");
}

Occupations::Placed Occupations::place(std::optional<UtcTime> at) {
    const auto latest = recorder_.latest();
    if (!latest) return {std::nullopt, no_sample()};
    if (!at) return {newest(), ""};
    if (*at > latest->utc) {
        return {std::nullopt, text::message("{} is later than the last sample, {}", shown(*at),
                                            shown(latest->utc))};
    }
    if (const auto placed = recorder_.at(*at)) return {placed, ""};
    return {
        std::nullopt,
        text::message("{} is earlier than the data that the daemon keeps in memory", shown(*at))};
}

/// Returns true if a change that was asked for at `at` was made at `utc`.
bool Occupations::is_at(std::optional<UtcTime> at, UtcTime utc) {
    if (!at || *at == utc) return at.has_value();  // Also if its sample is no longer in memory.
    const auto placed = place(at);
    return placed.instant && placed.instant->utc == utc;
}

/// Places the stop or a set-up of the running occupation.  A stop at the last sample may be at the start
/// of a further set-up, which then does not count.
Occupations::Placed Occupations::place_in_running(std::optional<UtcTime> at, bool is_stop) {
    if (!running()) return {std::nullopt, text::message("no occupation is running")};
    auto placed = place(at);
    if (placed.instant) placed.instant = in_running(*placed.instant);
    const UtcTime last = running()->set_ups.back();
    const bool is_after = placed.instant ? placed.instant->utc > last
                                         : !at || *at > last;  // Its data may have left memory.
    if (is_after || (is_stop && !at && running()->set_ups.size() > 1 && placed.instant &&
                     placed.instant->utc == last))
        return placed;
    return {std::nullopt, text::message("{} is not after the start of the set-up at {}, {}",
                                        shown(placed.instant ? placed.instant->utc : *at),
                                        running()->site, shown(running()->set_ups.back()))};
}

std::optional<text::Message> Occupations::trouble_with_site(std::string_view site) const {
    if (site.empty()) return text::message("no site is given");
    if (sites_.empty() || text::find_site(sites_, site)) return std::nullopt;
    const text::Site* const similar = text::similar_site(sites_, site);
    return text::message(
        "site {} is not one of the {} sites that a351ctl sites lists{}", site, sites_.size(),
        similar ? text::message("; did you mean {}?", similar->name) : text::Message());
}

/// Makes an event that needs no sample, because it must be possible with the sensor unplugged.
events::Event Occupations::about_now(std::string type) {
    if (const auto latest = newest()) return event_at(std::move(type), *latest);
    return {std::move(type), last_event_, {}, {}, {}};
}

Nanoseconds Occupations::planned() const noexcept {
    const bool has_own = running() && running()->planned_set_ups;
    return has_own ? *running()->planned_set_ups * kTestSetUp : options_.planned;
}

int Occupations::planned_set_ups() const noexcept {
    return running() ? running()->planned_set_ups.value_or(options_.planned_set_ups)
                     : options_.planned_set_ups;
}

int Occupations::planned_face(int set_up) const noexcept {
    if (!has_planned_faces()) return 1;
    const auto place = std::min(static_cast<std::size_t>(set_up), options_.faces.size()) - 1;
    return options_.faces[place] == '-' ? -1 : 1;
}

Outcome Occupations::start(std::string_view entered, const Remark& remark,
                           std::optional<UtcTime> at, std::optional<int> set_ups,
                           std::optional<int> face) {
    const std::string site = text::plain_text(entered);
    if (running()) {
        // An order to several boxes is repeated for those that did not answer.
        if (running()->site == site && is_at(at, running()->start))
            return unchanged(text::message("{} is running since {}, as ordered before",
                                           named(*running()), shown(running()->start)));
        return refused(text::message("{} has been running since {}: stop or discard it first",
                                     named(*running()), shown(running()->start)));
    }
    if (auto trouble = trouble_with_site(site)) return refused(*std::move(trouble));
    if (set_ups && !events::is_planned_set_ups(*set_ups))
        return refused(text::message("{} set-ups; allowed: {} to {}", *set_ups,
                                     events::kFewestPlannedSetUps, events::kMostPlannedSetUps));
    const auto placed = place(at);
    if (!placed.instant) return refused(placed.trouble);
    for (const auto& one : list()) {
        if (at && one.set_ups.front().start <= placed.instant->utc &&
            placed.instant->utc < one.set_ups.back().end) {
            return refused(text::message(
                "{} is within the occupation {}, {} to {}", shown(placed.instant->utc), named(one),
                shown(one.set_ups.front().start), shown(one.set_ups.back().end)));
        }
    }
    auto event = event_at("start", *placed.instant);
    add(event, "key", replay_.key_for(event.utc));
    add(event, "site", site);
    if (set_ups) add(event, "set_ups", std::to_string(*set_ups));
    add_face(event, {face, std::nullopt});
    add(event, remark);
    auto outcome = commit(std::move(event),
                          text::message("started {} at {}", site, shown(placed.instant->utc)));
    if (running() && running()->number > 1)
        outcome.message +=
            text::message("; the site was occupied before: stay {}", running()->number);
    for (const auto& one : list()) {
        if (!at || !running() || one.set_ups.front().start <= running()->start) continue;
        outcome.message += text::message("; {} began later, at {}: give the stop a time before it",
                                         named(one), shown(one.set_ups.front().start));
        break;
    }
    return outcome;
}

Outcome Occupations::stop(const Remark& remark, std::optional<UtcTime> at) {
    if (const auto all = list();
        !running() && !all.empty() && is_at(at, all.back().set_ups.back().end))
        return unchanged(text::message("{} was stopped at {}, as ordered before", named(all.back()),
                                       shown(all.back().set_ups.back().end)));
    const auto placed = place_in_running(at, true);
    if (!placed.instant) return refused(placed.trouble);
    const UtcTime utc = placed.instant->utc;
    for (const auto& one : list()) {
        const auto begin = one.set_ups.front().start;
        if (at && running()->start < begin && begin < utc) {
            return refused(text::message("{} lies between the start at {} and {}", named(one),
                                         running()->site, shown(utc)));
        }
    }
    auto event = event_at("stop", *placed.instant);
    add(event, "site", running()->site);
    add(event, remark);
    auto message = text::message("stopped {} at {}", named(*running()), shown(utc));
    const auto made = running()->set_ups.size() - (utc == running()->set_ups.back() ? 1U : 0U);
    if (static_cast<int>(made) < planned_set_ups()) {
        message += text::message("; {} of {} planned set-ups", made, planned_set_ups());
    }
    const text::Message clock = remark_on_clock();
    // A stop when the countdown shows zero keeps the plan.
    constexpr std::chrono::seconds kShorter{3};  // 0.05 min, below the last digit.
    const Nanoseconds stay = utc - running()->start;
    if (clock.empty() && planned() - stay >= kShorter) {
        message += text::message("; shorter than planned: {:.1f} of {:.0f} min",
                                 Minutes(stay).count(), Minutes(planned()).count());
    }
    return commit(std::move(event), message + clock);
}

Outcome Occupations::setup(std::optional<UtcTime> at, const events::StatedFace& face) {
    if (running() && running()->set_ups.size() > 1 && is_at(at, running()->set_ups.back()))
        return unchanged(text::message("further set-up at {} from {}, as ordered before",
                                       named(*running()), shown(running()->set_ups.back())));
    const auto placed = place_in_running(at, false);
    if (!placed.instant) return refused(placed.trouble);
    auto event = event_at("setup", *placed.instant);
    add(event, "site", running()->site);
    add_face(event, face);
    auto message = text::message("further set-up at {} from {}", named(*running()),
                                 shown(placed.instant->utc));
    message += remark_on_clock();
    return commit(std::move(event), std::move(message));
}

Outcome Occupations::add_site(const text::Site& site) {
    const auto& file = options_.sites_file;
    if (file.empty())
        return refused(text::message("there is no list of sites; set sites in [survey]"));
    const text::Site* const similar = text::similar_site(sites_, site.name);
    const text::Message remark =
        similar ? text::message("; a similar name is {}", similar->name) : text::Message();
    try {
        take(append_site(files::posix_files(), file, site));
    } catch (const InputError& error) {
        return refused(text::Message(error.what()));
    } catch (const std::system_error& error) {
        return {
            Outcome::Kind::failed,
            text::message("not added: {} cannot be written ({}); keep the list where the daemon "
                          "may write, for example in /var/lib/a351/sites",
                          file.string(), error.code().message())};
    }
    ++changes_;
    text::Message answer = text::message("added {}: {} sites in {}{}", site.name, sites_.size(),
                                         file.string(), remark);
    if (!doubtful_site_.empty()) answer += "; " + doubtful_site_;
    return {Outcome::Kind::done, answer};
}

void Occupations::use(std::vector<text::Site> sites, const OccupationOptions& options) {
    options_ = options;
    take(std::move(sites));
    ++changes_;
}

void Occupations::take(std::vector<text::Site> sites) {
    sites_ = std::move(sites);
    doubtful_site_ = text::doubtful_site(sites_, options_.station ? &*options_.station : nullptr);
}

void Occupations::end_at_exchange(events::Event event) {
    const auto& stay = running();
    const bool is_of_stay = stay && stay->session && stay->index &&
                            event.session == stay->session && event.index > stay->index;
    // After the clock was set back, the last sample seems to be before the stay.
    if (is_of_stay && event.utc + kLeastBack < stay->set_ups.back())
        event.utc = own_time({*event.session, *event.index, event.utc});
    recorder_.note(event);
    observe(event);
}

UtcTime Occupations::day_end() const {
    if (running()) return UtcTime::max();
    UtcTime end = UtcTime::min();
    for (const auto& one : list())
        end = std::max(end, one.set_ups.back().start + events::kSurveyNight);
    return end;
}

void Occupations::observe(const events::Event& event) {
    replay_.take(event);
    note_aside(event);
    ++changes_;
}

/// Notes what does not concern occupations.
void Occupations::note_aside(const events::Event& event) {
    last_event_ = event.utc;
    if (const std::string code = event.detail(kChecked); !code.empty())
        checked_[{code, event.detail("key")}] = event.utc;
}

Outcome Occupations::commit(events::Event event, text::Message message) {
    try {
        recorder_.commit(event);
    } catch (const std::system_error& error) {
        return {Outcome::Kind::failed, text::message("not saved: {}", error.what())};
    }
    observe(event);
    return {Outcome::Kind::done, std::move(message)};
}

}  // namespace a351::daemon::survey
