#include <fmt/core.h>

#include <algorithm>

#include "daemon/survey/event_texts.hpp"
#include "daemon/survey/occupations.hpp"

namespace a351::daemon::survey {
namespace {

using Minutes = std::chrono::duration<double, std::ratio<60>>;

std::string with_times(const events::Occupation& one) {
    return fmt::format("{}, {} to {}", named(one), shown(one.set_ups.front().start),
                       shown(one.set_ups.back().end));
}

}  // namespace

/// Returns the stay; std::nullopt and the reason if there is none, or if its site is another.
std::optional<Occupations::Found> Occupations::found(const Named& stay, std::string& trouble) {
    std::optional<Found> found;
    if (running() && running()->key == stay.key) {
        const auto latest = recorder_.latest();
        found = {Found::State::running, running()->site,
                 fmt::format("{}, running since {}", named(*running()), shown(running()->start)),
                 running()->start, latest ? latest->utc : running()->set_ups.back()};
    }
    const auto look_at = [&](const std::vector<events::Occupation>& stays, Found::State state) {
        for (const events::Occupation& one : stays)
            if (one.key == stay.key)
                found = {state, one.site, with_times(one), one.set_ups.front().start,
                         one.set_ups.back().end};
    };
    look_at(list(), Found::State::finished);
    look_at(discarded(), Found::State::discarded);
    if (!found) {
        trouble = fmt::format("no stay has the key {}; see the list", stay.key);
    } else if (!stay.site.empty() && stay.site != found->site) {
        trouble = fmt::format("the stay {} is at {}, not at {}; nothing was changed", stay.key,
                              found->site, stay.site);
        found.reset();
    }
    return found;
}

/// Returns what is wrong if a stay had these times; empty if nothing is.
std::string Occupations::trouble_with_overlap(const std::string& key, UtcTime start,
                                              UtcTime end) const {
    for (const events::Occupation& one : list())
        if (one.key != key && one.set_ups.front().start < end && start < one.set_ups.back().end)
            return "it would overlap " + with_times(one);
    if (running() && running()->key != key && running()->start < end)
        return fmt::format("it would overlap {}, running since {}", named(*running()),
                           shown(running()->start));
    return {};
}

/// Makes the event of a change with these key and site.
events::Event Occupations::change_of(std::string type, const Named& stay, const Remark& remark) {
    events::Event event = about_now(std::move(type));
    add(event, "key", stay.key);
    add(event, "site", stay.site);
    add(event, remark);
    return event;
}

Outcome Occupations::discard(const Named& stay, const Remark& remark) {
    std::string trouble;
    const auto one = found(stay, trouble);
    if (!one) return refused(trouble);
    if (one->state == Found::State::discarded) return refused(one->text + " is discarded already");
    events::Event event = change_of("discard", {stay.key, one->site}, remark);
    return commit(std::move(event), "discarded " + one->text);
}

Outcome Occupations::restore(const Named& stay, const Remark& remark) {
    std::string trouble;
    const auto one = found(stay, trouble);
    if (!one) return refused(trouble);
    if (one->state != Found::State::discarded) return refused(one->text + " is not discarded");
    if (trouble = trouble_with_overlap(stay.key, one->start, one->end); !trouble.empty())
        return refused(one->text + " cannot be restored: " + trouble);
    events::Event event = change_of("restore", {stay.key, one->site}, remark);
    return commit(std::move(event), "restored " + one->text);
}

Outcome Occupations::resume(const Named& stay, const Remark& remark) {
    std::string trouble;
    const auto one = found(stay, trouble);
    if (!one) return refused(trouble);
    if (running())
        return refused(fmt::format("{} has been running since {}", named(*running()),
                                   shown(running()->start)));
    if (one->state == Found::State::discarded)
        return refused(one->text + " is discarded: restore it first");
    if (!recorder_.latest()) return refused("no sample is available yet; see the status");
    events::Event event = change_of("resume", {stay.key, one->site}, remark);
    if (const Nanoseconds since = event.utc - one->end; since > kLongestResume)
        return refused(
            fmt::format("{} was stopped {:.1f} min ago; a stay is resumed at most {:.0f} "
                        "min after its stop: start a new one",
                        one->text, Minutes(since).count(), Minutes(kLongestResume).count()));
    if (trouble = trouble_with_overlap(stay.key, one->start, UtcTime::max()); !trouble.empty())
        return refused(one->text + " cannot be resumed: " + trouble);
    return commit(std::move(event), "resumed " + one->text);
}

Outcome Occupations::rename(const Named& stay, std::string_view site, const Remark& remark) {
    if (auto trouble = trouble_with_site(site)) return refused(*std::move(trouble));
    std::string trouble;
    const auto one = found(stay, trouble);
    if (!one) return refused(trouble);
    if (one->site == site) return refused(fmt::format("{} is at {} already", one->text, site));
    events::Event event = change_of("rename", {stay.key, std::string(site)}, remark);
    return commit(std::move(event), fmt::format("renamed {} to {}", one->text, site));
}

Outcome Occupations::retime(const Named& stay, std::optional<UtcTime> from,
                            std::optional<UtcTime> to, const Remark& remark) {
    std::string trouble;
    const auto one = found(stay, trouble);
    if (!one) return refused(trouble);
    if (!from && !to) return refused("neither a start nor an end is given");
    if (one->state == Found::State::discarded)
        return refused(one->text + " is discarded: restore it first");
    const bool is_running = one->state == Found::State::running;
    if (is_running && to)
        return refused(one->text + ": it has no end yet; stop it at the right time instead");
    const UtcTime start = from.value_or(one->start), end = to.value_or(one->end);
    const auto latest = recorder_.latest();
    if (!latest) return refused("no sample is available yet; see the status");
    if (std::max(start, end) > latest->utc)
        return refused(fmt::format("{} is later than the last sample, {}",
                                   shown(std::max(start, end)), shown(latest->utc)));
    if (start >= end)
        return refused(
            fmt::format("the start {} is not before the end {}", shown(start), shown(end)));
    trouble = trouble_with_overlap(stay.key, start, is_running ? UtcTime::max() : end);
    if (!trouble.empty()) return refused(one->text + " cannot have these times: " + trouble);
    events::Event event = change_of("retime", {stay.key, one->site}, remark);
    if (from) add(event, "from", to_rfc3339(*from, 9));
    if (to) add(event, "to", to_rfc3339(*to, 9));
    return commit(std::move(event), fmt::format("{} is now from {}{}", one->text, shown(start),
                                                is_running ? "" : " to " + shown(end)));
}

Outcome Occupations::not_moved(const Named& stay, const Remark& remark) {
    std::string trouble;
    const auto one = found(stay, trouble);
    if (!one) return refused(trouble);
    events::Event event = change_of("not_moved", {stay.key, one->site}, remark);
    if (event.utc == UtcTime{}) return refused("no sample is available yet; see the status");
    std::string said = fmt::format("{}: not moved until {}", one->text, shown(event.utc));
    return commit(std::move(event), std::move(said));
}

Outcome Occupations::note(const Named& stay, std::string_view text) {
    if (text.empty()) return refused("the note is empty");
    std::string said;
    if (!stay.key.empty()) {
        std::string trouble;
        const auto one = found(stay, trouble);
        if (!one) return refused(trouble);
        said = " for " + one->text;
    }
    events::Event event = change_of("note", {stay.key, ""}, {});
    if (event.utc == UtcTime{}) return refused("no sample is available yet; see the status");
    add(event, "note", text);
    said = "noted at " + shown(event.utc) + said;
    return commit(std::move(event), std::move(said));
}

}  // namespace a351::daemon::survey
