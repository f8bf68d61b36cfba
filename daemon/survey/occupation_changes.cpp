#include <fmt/core.h>

#include <algorithm>

#include "daemon/survey/event_texts.hpp"
#include "daemon/survey/occupations.hpp"
#include "protocol/text/plain_text.hpp"

namespace a351::daemon::survey {
namespace {

text::Message with_times(const events::Occupation& one) {
    return text::message("{}, {} to {}", named(one), shown(one.set_ups.front().start),
                         shown(one.set_ups.back().end));
}

}  // namespace

Occupations::Found Occupations::found(const Named& stay) {
    Found found;
    if (running() && running()->key == stay.key) {
        const auto latest = newest();
        found = {Found::State::running, running()->site,
                 text::message("{}, running since {}", named(*running()), shown(running()->start)),
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
    if (found.text.empty())
        found.trouble = text::message("no stay has the key {}; see the list", stay.key);
    else if (!stay.site.empty() && stay.site != found.site)
        found.trouble = text::message("the stay {} is at {}, not at {}; nothing was changed",
                                      stay.key, found.site, stay.site);
    return found;
}

/// Returns what is wrong if a stay had these times; empty if nothing is.
text::Message Occupations::trouble_with_overlap(const std::string& key, UtcTime start,
                                                UtcTime end) const {
    for (const events::Occupation& one : list())
        if (one.key != key && one.set_ups.front().start < end && start < one.set_ups.back().end)
            return text::message("it would overlap {}", with_times(one));
    if (running() && running()->key != key && running()->start < end)
        return text::message("it would overlap {}, running since {}", named(*running()),
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
    const Found one = found(stay);
    if (!one.trouble.empty()) return refused(one.trouble);
    if (one.state == Found::State::discarded)
        return refused(text::message("{} is discarded already", one.text));
    events::Event event = change_of("discard", {stay.key, one.site}, remark);
    return commit(std::move(event), text::message("discarded {}", one.text));
}

Outcome Occupations::restore(const Named& stay, const Remark& remark) {
    const Found one = found(stay);
    if (!one.trouble.empty()) return refused(one.trouble);
    if (one.state != Found::State::discarded)
        return refused(text::message("{} is not discarded", one.text));
    if (const auto trouble = trouble_with_overlap(stay.key, one.start, one.end); !trouble.empty())
        return refused(text::message("{} cannot be restored: {}", one.text, trouble));
    events::Event event = change_of("restore", {stay.key, one.site}, remark);
    return commit(std::move(event), text::message("restored {}", one.text));
}

Outcome Occupations::resume(const Named& stay, const Remark& remark) {
    const Found one = found(stay);
    if (!one.trouble.empty()) return refused(one.trouble);
    if (running())
        return refused(text::message("{} has been running since {}", named(*running()),
                                     shown(running()->start)));
    if (one.state == Found::State::discarded)
        return refused(text::message("{} is discarded: restore it first", one.text));
    if (!recorder_.latest()) return refused(no_sample());
    events::Event event = change_of("resume", {stay.key, one.site}, remark);
    if (const Nanoseconds since = event.utc - one.end; since > kLongestResume)
        return refused(
            text::message("{} was stopped {:.1f} min ago; a stay is resumed at most {:.0f} "
                          "min after its stop: start a new one",
                          one.text, Minutes(since).count(), Minutes(kLongestResume).count()));
    if (const auto trouble = trouble_with_overlap(stay.key, one.start, UtcTime::max());
        !trouble.empty())
        return refused(text::message("{} cannot be resumed: {}", one.text, trouble));
    return commit(std::move(event), text::message("resumed {}", one.text));
}

Outcome Occupations::rename(const Named& stay, std::string_view entered, const Remark& remark) {
    const std::string site = text::plain_text(entered);
    if (auto trouble = trouble_with_site(site)) return refused(*std::move(trouble));
    const Found one = found(stay);
    if (!one.trouble.empty()) return refused(one.trouble);
    if (one.site == site) return refused(text::message("{} is at {} already", one.text, site));
    events::Event event = change_of("rename", {stay.key, site}, remark);
    return commit(std::move(event), text::message("renamed {} to {}", one.text, site));
}

Outcome Occupations::retime(const Named& stay, std::optional<UtcTime> from,
                            std::optional<UtcTime> to, const Remark& remark) {
    const Found one = found(stay);
    if (!one.trouble.empty()) return refused(one.trouble);
    if (!from && !to) return refused(text::message("neither a start nor an end is given"));
    if (one.state == Found::State::discarded)
        return refused(text::message("{} is discarded: restore it first", one.text));
    const bool is_running = one.state == Found::State::running;
    if (is_running && to)
        return refused(
            text::message("{}: it has no end yet; stop it at the right time instead", one.text));
    const UtcTime start = from.value_or(one.start), end = to.value_or(one.end);
    const auto latest = recorder_.latest();
    if (!latest) return refused(no_sample());
    if (std::max(start, end) > latest->utc)
        return refused(text::message("{} is later than the last sample, {}",
                                     shown(std::max(start, end)), shown(latest->utc)));
    if (start >= end)
        return refused(
            text::message("the start {} is not before the end {}", shown(start), shown(end)));
    const bool is_early = start < one.start - kFarthestRetime;
    if (is_early || end > one.end + kFarthestRetime)
        return refused(text::message("{} is more than a day outside the stay: check its date",
                                     shown(is_early ? start : end)));
    const auto trouble = trouble_with_overlap(stay.key, start, is_running ? UtcTime::max() : end);
    if (!trouble.empty())
        return refused(text::message("{} cannot begin at {} and end at {}: {}", one.text,
                                     shown(start), shown(end), trouble));
    events::Event event = change_of("retime", {stay.key, one.site}, remark);
    if (from) add(event, "from", to_rfc3339(*from, 9));
    if (to) add(event, "to", to_rfc3339(*to, 9));
    return commit(
        std::move(event),
        is_running ? text::message("{} is now from {}", one.text, shown(start))
                   : text::message("{} is now from {} to {}", one.text, shown(start), shown(end)));
}

Outcome Occupations::not_moved(const Named& stay, const Remark& remark) {
    const Found one = found(stay);
    if (!one.trouble.empty()) return refused(one.trouble);
    events::Event event = change_of("not_moved", {stay.key, one.site}, remark);
    if (event.utc == UtcTime{}) return refused(no_sample());
    text::Message said = text::message("{}: not moved until {}", one.text, shown(event.utc));
    return commit(std::move(event), std::move(said));
}

Outcome Occupations::check(const Contradiction& contradiction) {
    events::Event event = change_of("note", {contradiction.key, ""}, {});
    if (event.utc == UtcTime{}) return refused(no_sample());
    add(event, kChecked, contradiction.code);
    add(event, "note", "checked: " + contradiction.text.english());
    return commit(std::move(event), text::message("checked: {}", contradiction.text));
}

Outcome Occupations::note(const Named& stay, std::string_view text) {
    if (text.empty()) return refused(text::message("the note is empty"));
    events::Event event = change_of("note", {stay.key, ""}, {});
    text::Message said = text::message("noted at {}", shown(event.utc));
    if (!stay.key.empty()) {
        const Found one = found(stay);
        if (!one.trouble.empty()) return refused(one.trouble);
        said = text::message("noted at {} for {}", shown(event.utc), one.text);
    }
    if (event.utc == UtcTime{}) return refused(no_sample());
    add(event, "note", text);
    return commit(std::move(event), std::move(said));
}

}  // namespace a351::daemon::survey
