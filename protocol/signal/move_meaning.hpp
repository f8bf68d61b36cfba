#pragma once
/// @file
/// The meaning of a move of the box for a set-up: a change of set-ups, a forgotten *Next set-up*, a
/// late stop or an early start.  The live question and the correction in the evening use this one
/// judgement.
///
///     const JudgedSetUp judged = judge_moves(samples, {.start = start, .end = end});
///     // judged.part is the set-up; judged.at_end says why it ends before its last sample.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/signal/moved_box.hpp"

namespace a351::signal {

/// The event that ended a set-up.
enum class SetUpEnd {
    next_set_up,  ///< The operator pressed *Next set-up*.
    stop,
    not_stopped,  ///< The start of the next stay, or the end of the record.
    running,      ///< Nothing yet.
};

/// A set-up as it was entered.
struct EnteredSetUp {
    UtcTime start;
    UtcTime end;  ///< For a running one: now.
    SetUpEnd ended_by = SetUpEnd::stop;
    bool began_with_next_set_up = false;  ///< Otherwise with the start of the stay.
    /// The operator says that the box was not moved before this instant.
    std::optional<UtcTime> not_moved_until = {};
};

/// The part of a set-up in which the box did not move: samples [first, end).
struct StillPart {
    std::size_t first = 0, end = 0;
    bool operator==(const StillPart&) const = default;
};

/// Why a set-up begins after its first sample, or ends before its last one.
enum class MoveMeaning {
    none,               ///< It does not.
    change_of_set_ups,  ///< As it should be: nothing is to be said.
    early_start,
    forgotten_set_up,  ///< *Next set-up* was not pressed.
    late_stop,         ///< The box was carried off, kicked or put elsewhere.
    may_be_change,     ///< The set-up runs, and *Next set-up* may still be pressed.
};

struct JudgedSetUp {
    StillPart part;  ///< Empty if the box was never at rest, and was shaken for a minute or more.
    MoveMeaning at_start = MoveMeaning::none, at_end = MoveMeaning::none;
    std::vector<BoxMove> forgotten = {};  ///< Where a set-up begins that was not entered.
};

/// Finds the part of a set-up in which the box did not move, and what the moves beside it mean.
///
/// The part between two moves is the first with three minutes at rest, or else that with the most
/// time at rest.  Reason: a stop is forgotten more often than a start is pressed too early, and then
/// only seconds before the box is set down.  A minute or more of shaking at either end is left out:
/// there the box was handled, carried or driven.  Moves with less than three minutes at rest between
/// them are one, levelled in several goes.
///
/// A drive is shaking of two minutes, without a minute at rest in it.
///
/// - Change of set-ups: the last move, without a drive, began up to ten minutes before *Next set-up*;
///   or the first one, without a drive, began up to one minute after it.
/// - Forgotten set-up: in each move the box is handled, and at rest again within three minutes at a
///   gravity that differs by less than 5 mGal; then it is at rest for a minute before the stop, or for
///   three minutes while the set-up runs; and there is no drive.  A set-up without a stop has none,
///   because it lasts until the next benchmark.  A next benchmark that is as near and as similar is not
///   distinguished.
/// - May be a change: the set-up runs, and the box was handled and is not at rest for three minutes.
/// - Late stop, early start: any other move.  If the box was handled in the ten minutes before a late
///   stop, the part ends there, because the way to a car may be quiet.
///
/// No cut remains at or before the operator's answer that the box was not moved.
///
/// Accuracy (move_meaning_test.cpp): of 67 made-up stays each that end with a drive, a lift and a kick,
/// at least 95 % end within 15 s of the move; an early start moves to within 14 s of the instant at
/// which the box was set down.  At least 95 % of 50 made-up lifts are forgotten set-ups, and none of 100
/// drives to another benchmark.
/// @param samples  one in 2 s, in order of time, from within the set-up.
[[nodiscard]] JudgedSetUp judge_moves(std::span<const MotionSample> samples,
                                      const EnteredSetUp& entered);

}  // namespace a351::signal
