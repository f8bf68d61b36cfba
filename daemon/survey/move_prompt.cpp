#include "daemon/survey/move_prompt.hpp"

namespace a351::daemon::survey {

std::optional<MovePrompt> move_prompt(std::span<const signal::MotionSample> samples,
                                      const signal::EnteredSetUp& entered) {
    using signal::MoveMeaning;
    const signal::JudgedSetUp judged = signal::judge_moves(samples, entered);
    const signal::StillPart part = judged.part;
    if (judged.at_end == MoveMeaning::late_stop || judged.at_end == MoveMeaning::forgotten_set_up)
        return MovePrompt{.time = samples[part.end].time,
                          .is_set_up = judged.at_end == MoveMeaning::forgotten_set_up};
    if (judged.at_start == MoveMeaning::early_start)
        return MovePrompt{.time = samples[part.first].time, .is_at_start = true};
    return std::nullopt;
}

text::Message text_of(const MovePrompt& prompt) {
    const std::string time = to_rfc3339(prompt.time, 0);
    if (prompt.is_at_start)
        return text::message(
            "the box was moved until {}: let the stay begin at that time, or say that it was not "
            "moved",
            time);
    return prompt.is_set_up
               ? text::message(
                     "the box was lifted and set down at {}: begin the next set-up at that time, "
                     "or say that it was not moved",
                     time)
               : text::message(
                     "the box was moved at {}: stop at that time, or say that it was not moved",
                     time);
}

}  // namespace a351::daemon::survey
