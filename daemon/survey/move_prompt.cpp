#include "daemon/survey/move_prompt.hpp"

#include <algorithm>

namespace a351::daemon::survey {
namespace {

constexpr std::size_t kCarried = 60;  // samples shaken: two minutes, longer than a lorry

}  // namespace

std::optional<MovePrompt> move_prompt(std::span<const signal::MotionSample> samples,
                                      std::optional<UtcTime> not_moved_until) {
    const auto [part, moves] = signal::answered_stay(samples, not_moved_until);
    if (part.first == part.end) return std::nullopt;  // not at rest yet
    const bool is_at_rest_again = std::ranges::any_of(
        moves, [end = part.end](const auto& move) { return move.after >= end; });
    if (part.end < samples.size() && (is_at_rest_again || samples.size() - part.end >= kCarried))
        return MovePrompt{samples[part.end].time, false};
    if (part.first == 0) return std::nullopt;
    return MovePrompt{samples[part.first].time, true};
}

text::Message text_of(const MovePrompt& prompt) {
    const std::string time = to_rfc3339(prompt.time, 0);
    return prompt.is_at_start
               ? text::message(
                     "the box was moved until {}: should the stay begin at that time, or was the "
                     "box not moved?",
                     time)
               : text::message(
                     "the box was moved at {}: stop at that time, next set-up at that time, or was "
                     "it not moved?",
                     time);
}

}  // namespace a351::daemon::survey
