#include "daemon/survey/operator_signal.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>

#include "daemon/verdict/live_sample.hpp"

namespace a351::daemon::survey {
namespace {

/// After this time without a call there is no series of words, only the present one.
constexpr auto kMostBehind = std::chrono::hours(1);

Contradiction of_move(const MovePrompt& moved, const std::string& key) {
    return {kMoved,
            key,
            text_of(moved),
            {moved.is_at_start ? "begin_at"
             : moved.is_set_up ? "setup_at"
                               : "stop_at",
             "not_moved"}};
}

}  // namespace

std::vector<Contradiction> open_contradictions(const status::Status& status,
                                               const Occupations& occupations,
                                               const std::optional<MovePrompt>& moved,
                                               const text::Message& wrong_face,
                                               const SoFar& so_far) {
    std::vector<Contradiction> all;
    for (const text::Message& trouble : status.sensor_troubles)
        all.push_back({"sensor: " + trouble.english(), "", trouble, {kChecked}});
    if (const auto unit = status::unit_warning(status))
        all.push_back(
            {"other_unit " + to_rfc3339(status.unit_change->since), "", *unit, {kChecked}});
    const auto& running = occupations.running();
    if (moved && running) all.push_back(of_move(*moved, running->key));
    // Each set-up has a question of its own.
    if (!wrong_face.empty())
        all.push_back({fmt::format("{} {}", kFace, running->set_ups.size()),
                       running->key,
                       wrong_face,
                       {"setup", kChecked}});
    // Those of another day are not to be cleared up now.
    const auto day = survey_day(occupations, status.now);
    for (const Contradiction& one : so_far.contradictions) {
        const bool is_running = running && one.key == running->key;
        const bool is_of_day = one.key.empty()
                                   ? running || !day.empty()
                                   : std::ranges::count(day, one.key, &events::Occupation::key) > 0;
        if (!is_running && !is_of_day) continue;
        all.push_back(one);
        if (is_running && one.code == "set_ups") all.back().buttons = {"setup", kChecked};
    }
    std::erase_if(
        all, [&](const Contradiction& one) { return occupations.is_checked(one, status.now); });
    return all;
}

Signal operator_signal(status::Status& status, const verdict::Verdict& verdict,
                       const std::vector<text::Message>& why, const Occupations& occupations,
                       const FieldStatus& field, const SoFar& so_far) {
    const auto day = survey_day(occupations, status.now);
    auto stay = field.stay;
    if (stay) {
        const auto gravity = so_far.stays.find(occupations.running()->key);
        stay->is_compared = gravity != so_far.stays.end() && gravity->second.gravity.has_value();
    }
    Signal signal =
        signal_of(verdict, why, stay, day.empty() ? std::string() : day.back().site,
                  open_contradictions(status, occupations, field.moved, field.face, so_far));
    if (signal.word == Word::no_data && status.level == status::Status::Level::good)
        status.warn(signal.sentence);
    // The sentence may have the plan too.
    if (signal.look && std::ranges::count(status.reasons, signal.look->text) == 0)
        status.warn(signal.look->text);
    return signal;
}

Word SignalLog::advance(const status::Status& status, const SoFar& so_far) {
    const auto last = live_.last_sample();
    if (!last) return word_;
    const auto moved = moved_box(occupations_, live_, *last);
    const bool has_contradiction =
        !open_contradictions(status, occupations_, moved, wrong_face(occupations_, live_, *last),
                             so_far)
             .empty();
    constexpr Nanoseconds kStep = from_seconds(verdict::kLiveStepSeconds);
    // Also after a clock that was set back.
    if (!end_ || *last < *end_ - kStep || *last - *end_ > kMostBehind) {
        end_ = *last;
        lasting_ = LastingWord(*last);
    }
    // While the clock is behind the stay, the stay runs all the same.
    const auto& running = occupations_.running();
    const UtcTime begin =
        running && *last < running->set_ups.back() ? running->set_ups.back() : UtcTime::min();
    for (; *end_ <= *last; *end_ += kStep) {
        word_ =
            word_of(live_.state_at(*end_),
                    planned_stay(occupations_, live_, std::max(*end_, begin)), has_contradiction);
        const auto change = lasting_.take(word_, *end_);
        if (!change) continue;
        events::Event event{"signal", change->since, {}, {}, {}};
        event.details["word"] = code_of(change->word);
        note_(event);
    }
    return word_;
}

}  // namespace a351::daemon::survey
