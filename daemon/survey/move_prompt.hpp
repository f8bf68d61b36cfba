#pragma once

#include <optional>
#include <span>
#include <string>

#include "protocol/core/utc_time.hpp"
#include "protocol/signal/move_meaning.hpp"
#include "protocol/text/message.hpp"

namespace a351::daemon::survey {

/// The running stay does not agree with the box: it was moved while the stay ran, or not yet at rest
/// when it was started.
///
/// The operator answers: stop at `time`, next set-up at `time` (for a start: begin at `time`), or "it
/// was not moved".
struct MovePrompt {
    UtcTime time;              ///< When the box was moved; for an early start: when it stood.
    bool is_at_start = false;  ///< The stay was started before the box stood.
    bool is_set_up = false;    ///< *Next set-up* was forgotten: it is the first answer.

    [[nodiscard]] bool operator==(const MovePrompt&) const = default;
};

/// Returns what is to be asked about the running set-up (signal::judge_moves(), as in the evening).
///
/// Nothing is asked while the box may be between two set-ups: until it was driven for two minutes, or
/// at rest again for three.  A kick is asked about at once.
/// @param samples  one in 2 s, from the start of the set-up to now.
/// Accuracy: move_prompt_test.cpp.
[[nodiscard]] std::optional<MovePrompt> move_prompt(std::span<const signal::MotionSample> samples,
                                                    const signal::EnteredSetUp& entered);

/// Returns the question in words, with the time.
[[nodiscard]] text::Message text_of(const MovePrompt& prompt);

}  // namespace a351::daemon::survey
