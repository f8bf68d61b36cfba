#pragma once
/// @file
/// Finds out when the box was moved while a stay was recorded: carried to the next benchmark,
/// lifted and set down, kicked, or not yet set down.
///
///     const std::vector<BoxMove> moves = find_box_moves(samples);
///     const StillPart part = choose_still_part(samples, moves);   // where the box was at rest
///
/// At rest the level of the box does not change.  A shock or a lorry alone is not a move.

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::signal {

/// A decimated sample and how much the box shook around it.
struct MotionSample {
    UtcTime time;
    std::array<MilliGal, 3> axes;  ///< Decimated axes; NaN if missing.
    MilliGal shake;  ///< Half peak to peak of the worst axis, raw samples; may be NaN.
};

/// A move of the box.
struct BoxMove {
    std::size_t before = 0;  ///< Last sample at rest before it.
    std::size_t after = 0;   ///< First sample at rest after it.
    double tilt_deg = 0.0;   ///< Change of the level, deg.
    MilliGal norm;           ///< Change of the mean of the norm.
};

/// Returns the moves, in order of time.
///
/// The means of the axes over ten samples at rest on either side of each instant are compared.
/// The box has moved if
/// - its level changes by more than 0.02 deg, or
/// - between both it was handled (shaken above 2 Gal for 5 s) and its level changes by more than
///   0.005 deg or the norm by more than 10 mGal.
///
/// A sample is at rest if no sample within 10 s, the reach of the decimation, is shaken above 2 Gal.
/// A sample with a missing axis (NaN) is never at rest; a missing shake counts as no shaking.
///
/// Cost: O(n).
/// Accuracy (moved_box_test.cpp): of 67 made-up stays each that end with a drive, a lift by 10 cm
/// and a kick of 0.05 deg, at least 95 % are found, with the end within 15 s.  None of 200 stays with
/// a lorry, knocks, and hands that tilt the box by 0.001 deg has a move.  corrector/methods.md has
/// simulated days.
/// @param samples  one in 2 s, in order of time; neither is checked.
/// @return none with fewer than 20 samples at rest.
[[nodiscard]] std::vector<BoxMove> find_box_moves(std::span<const MotionSample> samples);

/// The part of a stay in which the box did not move: samples [first, end).
struct StillPart {
    std::size_t first = 0, end = 0;
    bool operator==(const StillPart&) const = default;
};

/// Returns the part between two moves that is the stay: the first with three minutes at rest, or
/// else that with the most time at rest.  Reason: a stop is forgotten more often than a start is
/// pressed too early, and then only seconds before the box is set down.
///
/// If the box was handled in the ten minutes before the move that ends the part, it ends there,
/// because the way to a car may be quiet.
/// A minute or more of shaking at either end is left out: there the box was carried or driven.
///
/// Accuracy: as find_box_moves(); a start that was pressed too early moves to within 14 s of the
/// instant at which the box was set down (moved_box_test.cpp).
/// @param moves  find_box_moves() of the samples.
/// @return all samples if there is neither; none if the box was never at rest
///         and was shaken for a minute or more.
[[nodiscard]] StillPart choose_still_part(std::span<const MotionSample> samples,
                                          const std::vector<BoxMove>& moves);

/// Returns true if the moves only lifted the box: in each it is handled, and at rest again within two
/// minutes at a gravity that differs by less than 5 mGal; and between them it is at rest for three
/// minutes.  A next benchmark that is as near and as similar is not distinguished.
///
/// Accuracy (moved_box_test.cpp): at least 95 % of 50 made-up lifts are recognised, and none of 100
/// drives to another benchmark is taken for one.
/// @param moves  find_box_moves() of the samples.
/// @return false without a move, or if the box is shaken for a minute or more between moves.
[[nodiscard]] bool was_only_lifted(std::span<const MotionSample> samples,
                                   const std::vector<BoxMove>& moves);

/// The stay as it is after the operator's answer that the box was not moved before an instant.
struct AnsweredStay {
    StillPart part;              ///< choose_still_part(), without cuts at or before the instant.
    std::vector<BoxMove> moves;  ///< Moves after it.
};

/// Returns the part of a stay in which the box did not move.
///
/// No cut remains at or before the answer (moved_box_test.cpp).
/// @param not_moved_until  the answer; absent: there is none.
[[nodiscard]] AnsweredStay answered_stay(std::span<const MotionSample> samples,
                                         std::optional<UtcTime> not_moved_until);

}  // namespace a351::signal
