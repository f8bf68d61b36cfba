#pragma once

#include <optional>
#include <span>
#include <string>

#include "protocol/core/utc_time.hpp"
#include "protocol/signal/moved_box.hpp"
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

    [[nodiscard]] bool operator==(const MovePrompt&) const = default;
};

/// Returns what is to be asked about the running set-up.
///
/// Moves are those of signal::find_box_moves(), the same as in the evening.  A box that is shaken for
/// more than two minutes without an end is being carried; a lorry of a minute is not.
/// @param samples          one in 2 s, from the start of the set-up to now.
/// @param not_moved_until  the operator says that the box was not moved before.
/// Accuracy: move_prompt_test.cpp.
[[nodiscard]] std::optional<MovePrompt> move_prompt(std::span<const signal::MotionSample> samples,
                                                    std::optional<UtcTime> not_moved_until);

/// Returns the question in words, with the time.
[[nodiscard]] text::Message text_of(const MovePrompt& prompt);

}  // namespace a351::daemon::survey
