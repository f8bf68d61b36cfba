#include <functional>

#include "daemon/page/field_values.hpp"
#include "daemon/page/status_json.hpp"

namespace a351::daemon::page {
namespace {

using nlohmann::json;
using text::marked;

bool has_stay(const Moment& now) { return now.occupations.running().has_value(); }
bool has_level(const Moment& now) { return !now.field.level_site.empty(); }

template <class Get>
auto of_stay(Get get) {
    return only_if(has_stay, get);
}

template <class Get>
auto of_level(Get get) {
    return only_if(has_level, get);
}

/// Returns the begin of the verdict; std::nullopt if it is not known.
std::optional<UtcTime> begin_of(const verdict::Verdict& verdict) {
    return verdict.since == UtcTime{} ? std::nullopt : std::optional(verdict.since);
}

Fields signal_fields() {
    return {
        {.path = "/signal/word",
         .value = [](const Moment& now) { return json(survey::code_of(now.signal.word)); },
         .meaning = "What the operator is to do now: no_data, warming_up, keep_off, lift, go or "
                    "look.",
         .metric = {.name = "a351_signal",
                    .key = "word",
                    .as = Metric::As::states,
                    .help = "1 for the present word of the signal.",
                    .states = {"no_data", "warming_up", "keep_off", "lift", "go", "look"}}},
        {.path = "/signal/text",
         .value = [](const Moment& now) { return json(now.signal.text); },
         .meaning = "The word as people read it."},
        {.path = "/signal/sentence",
         .value = [](const Moment& now) { return json(now.signal.sentence.english()); },
         .meaning = "The reason and what to do, see SENTENCES."},
        {.path = "/signal/parts",
         .value = [](const Moment& now) { return now.signal.sentence.to_json(); },
         .meaning = "The same with its parts."},
        {.path = "/signal/buttons",
         .value = [](const Moment& now) { return json(now.signal.buttons); },
         .meaning = "At most two orders that fit: start, setup, stop, stop_at, setup_at, begin_at "
                    "(at the time of the move), not_moved, checked."},
        {.path = "/signal/look",
         .value =
             [](const Moment& now) {
                 const auto& look = now.signal.look;
                 return look ? json{{"code", look->code}, {"key", look->key}} : json();
             },
         .meaning = "With the word look, what contradicts: code, and key of the stay or an empty "
                    "text; else null."},
    };
}

Fields detail_fields() {
    const auto of_verdict = [](auto get) {
        return [get](const Moment& now) { return json_of(get(now.judgement.verdict)); };
    };
    return {
        {.path = "/details/state",
         .value = of_verdict([](const auto& verdict) { return verdict::to_text(verdict.state); }),
         .meaning = "State of the uncorrected reading: no data, warming up, settling, stable or "
                    "disturbed."},
        {.path = "/details/since",
         .value = of_verdict(begin_of),
         .meaning = "Time since which this is the state."},
        {.path = "/details/held_s",
         .value =
             [](const Moment& now) {
                 const auto since = begin_of(now.judgement.verdict);
                 return since ? json(seconds_between(*since, now.status.now)) : json();
             },
         .meaning = "Time for which it has not changed.",
         .unit = "s"},
        {.path = "/details/time_left_s",
         .value = of_verdict([](const auto& verdict) { return verdict.time_left_s; }),
         .meaning = "Least time until it can be stable, null if more than waiting is needed.",
         .unit = "s"},
        {.path = "/details/reasons",
         .value = [](const Moment& now) { return json(now.judgement.reasons); },
         .meaning = "Why it is not stable, see SENTENCES."},
        {.path = "/details/reason_parts",
         .value = [](const Moment& now) { return parts_of(now.judgement.reasons); },
         .meaning = "The same with their parts."},
        {.path = "/details/checks",
         .value = [](const Moment& now) { return checks_of(now.judgement.verdict); },
         .meaning =
             "All checks, those not met first, each with quantity, value, error (standard error of "
             "the value, null if it has none), unit, ending (words after the unit), limit, "
             "is_least (true: the value must reach the limit; false: must not exceed it) and "
             "is_met."},
    };
}

Fields stay_fields() {
    return {
        {.path = "/occupation",
         .value =
             [](const Moment& now) {
                 const auto& running = now.occupations.running();
                 return running ? to_json(*running, now.status.now) : json();
             },
         .meaning =
             "The running stay, null if none runs: key, site, number (of the stay at this site), "
             "operator, note, start, set_up (start of the set-up that runs), set_up_count "
             "(number of this set-up, from 1), running_s (time since start), session and index "
             "(of the first sample, null if the start was moved).",
         .metric = {.name = "a351_occupation_running",
                    .as = Metric::As::existence,
                    .help = "1 while an occupation runs."}},
        {.path = "/occupation/planned_s",
         .value = of_stay([](const Moment& now) { return now.occupations.planned(); }),
         .meaning = "Planned length of all set-ups together.",
         .unit = "s"},
        {.path = "/occupation/planned_set_ups",
         .value = of_stay([](const Moment& now) { return now.field.stay->plan.planned; }),
         .meaning = "Planned number of set-ups."},
        {.path = "/occupation/has_own_plan",
         .value = of_stay([](const Moment& now) {
             return now.occupations.running()->planned_set_ups.has_value();
         }),
         .meaning = "True if the plan was given with the start, not by the configuration."},
        {.path = "/occupation/set_up_left_s",
         .value = of_stay([](const Moment& now) { return now.field.stay->plan.left_s; }),
         .meaning = "Time left in the set-up; beyond the plan, in the stay.",
         .unit = "s"},
        {.path = "/occupation/gravity",
         .value = of_stay([](const Moment& now) {
             return gravity_of(now.so_far, now.occupations.running()->key);
         }),
         .meaning = "Gravity so far of the stay, null before it is computed: gravity_mgal, u_mgal "
                    "(its standard uncertainty by the evening), and missing_parts, what is needed "
                    "before they are known."},
        {.path = "/occupation/reading",
         .value = of_stay([](const Moment& now) {
             return now.field.reading ? to_json(*now.field.reading) : json();
         }),
         .meaning = "Reading of the running set-up, see A READING."},
        {.path = "/occupation/whole",
         .value = of_stay([](const Moment& now) { return to_json(now.field.whole); }),
         .meaning = "Reading of all set-ups together, see A READING."},
        {.path = "/occupation/warnings",
         .value = of_stay([](const Moment& now) { return json(now.field.warnings); }),
         .meaning = "Warnings on the stay, see SENTENCES."},
        {.path = "/occupation/warning_parts",
         .value = of_stay([](const Moment& now) { return parts_of(now.field.warnings); }),
         .meaning = "The same with their parts."},
        {.path = "/occupation/moved",
         .value = of_stay([](const Moment& now) {
             if (!now.field.moved) return json();
             return json{{"utc", json_of(now.field.moved->time)},
                         {"is_at_start", now.field.moved->is_at_start},
                         {"is_set_up", now.field.moved->is_set_up}};
         }),
         .meaning = "Move of the box, null if nothing is to be asked about one: utc, its time; "
                    "is_at_start, true if the stay was started before the box was at rest; "
                    "is_set_up, true if the box was lifted and set down without Next set-up."},
    };
}

Fields tilt_fields() {
    const auto of_angle = [](std::size_t axis) {
        return of_level([axis](const Moment& now) {
            return now.field.level ? json(now.field.level->tilt_arcmin[axis]) : json();
        });
    };
    const auto advice = [](const Moment& now) {
        return now.field.level ? now.field.level->advice : std::vector<text::Message>();
    };
    return {
        {.path = "/tilt",
         .value = null_without(has_level),
         .meaning = "Tilt of the box compared with the first set-up of the day; null before there "
                    "is one, and while the box must not be touched."},
        {.path = "/tilt/axes",
         .value = of_level([](const Moment& now) {
             const auto axes = now.field.level.value_or(live::Level{}).axes;
             return json{std::string(1, axes[0]), std::string(1, axes[1])};
         }),
         .meaning = "Names of the two level axes."},
        {.path = "/tilt/x_arcmin",
         .value = of_angle(0),
         .meaning = "Tilt along the first one.",
         .unit = "arcmin"},
        {.path = "/tilt/y_arcmin",
         .value = of_angle(1),
         .meaning = "Tilt along the second one.",
         .unit = "arcmin"},
        {.path = "/tilt/limit_arcmin",
         .value = of_level([](const Moment&) { return live::kMostTiltArcmin; }),
         .meaning = "Largest tilt that is accepted.",
         .unit = "arcmin"},
        {.path = "/tilt/is_within",
         .value = of_level([](const Moment& now) {
             return now.field.level ? json(now.field.level->is_within) : json();
         }),
         .meaning = "True if the tilt is within the limit."},
        {.path = "/tilt/advice",
         .value = of_level([advice](const Moment& now) { return json(advice(now)); }),
         .meaning = "How to level the box, see SENTENCES."},
        {.path = "/tilt/advice_parts",
         .value = of_level([advice](const Moment& now) { return parts_of(advice(now)); }),
         .meaning = "The same with their parts."},
        {.path = "/tilt/reference",
         .value = of_level([](const Moment& now) {
             return json{{"site", now.field.level_site}, {"utc", json_of(now.field.level_utc)}};
         }),
         .meaning = "That first set-up: its site, and utc, its start."},
    };
}

}  // namespace

Judgement judged(const status::Status& status, Nanoseconds stale_after) {
    if (!status.last_sample) return {{}, {text::message("no sample has been received yet")}};
    if (status.now - *status.last_sample > stale_after) {
        return {{verdict::State::no_data, *status.last_sample, {}},
                {text::message("last sample {:.1f} s ago",
                               seconds_between(*status.last_sample, status.now))}};
    }
    std::vector<text::Message> reasons;
    for (const verdict::Reason& reason : status.verdict.reasons)
        if (!reason.is_met) reasons.push_back(reason.to_message());
    return {status.verdict, reasons};
}

Fields operator_fields() {
    return concatenated({signal_fields(), stay_fields(), tilt_fields(), detail_fields()});
}

}  // namespace a351::daemon::page
