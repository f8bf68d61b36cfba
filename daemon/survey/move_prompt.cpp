#include "daemon/survey/move_prompt.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace a351::daemon::survey {
namespace {

constexpr std::size_t kCarried = 60;  // samples shaken: two minutes, longer than a lorry

}  // namespace

std::optional<MovePrompt> move_prompt(std::span<const signal::MotionSample> samples,
                                      std::optional<UtcTime> not_moved_until) {
    std::vector<signal::BoxMove> moves = signal::find_box_moves(samples);
    if (not_moved_until)
        std::erase_if(moves, [&](const signal::BoxMove& move) {
            return samples[move.after].time <= *not_moved_until;
        });
    const signal::StillPart part = signal::choose_still_part(samples, moves);
    if (part.first == part.behind) return std::nullopt;  // not at rest yet
    if (part.behind < samples.size()) {
        const bool is_at_rest_again =
            std::ranges::any_of(moves, [&](const auto& move) { return move.after >= part.behind; });
        MovePrompt prompt{samples[part.behind].time, false};
        const auto is_answered = [&] { return not_moved_until && prompt.time <= *not_moved_until; };
        // The last handling before the move may be the one that was answered.
        if (is_answered() && !moves.empty())
            prompt.time = samples[(moves.front().before + moves.front().after) / 2].time;
        if (!is_answered() && (is_at_rest_again || samples.size() - part.behind >= kCarried))
            return prompt;
    }
    if (part.first == 0 || (not_moved_until && samples[part.first].time <= *not_moved_until))
        return std::nullopt;
    return MovePrompt{samples[part.first].time, true};
}

std::string text_of(const MovePrompt& prompt) {
    const std::string time = to_rfc3339(prompt.time, 0);
    return prompt.is_at_start
               ? fmt::format("the box was moved until {}: begin there, or was it not moved?", time)
               : fmt::format(
                     "the box was moved at {}: stop there, next set-up there, or was it not "
                     "moved?",
                     time);
}

}  // namespace a351::daemon::survey
