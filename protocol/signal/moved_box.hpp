#pragma once
/// @file
/// Finds out when the box was moved while a stay was recorded: carried to the next benchmark,
/// lifted and set down, kicked, or not yet set down.
///
/// At rest the level of the box does not change.  A shock or a lorry alone is not a move.
/// The meaning of a move for a set-up is in move_meaning.hpp.

#include <array>
#include <cstddef>
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

/// Returns true if the box is shaken above 2 Gal: by hands, on a drive, by a near lorry.
[[nodiscard]] bool is_shaken(const MotionSample& sample);

/// Returns true if the samples [from, to) are shaken for 5 s or more, as by hands.
[[nodiscard]] bool is_handled(std::span<const MotionSample> samples, std::size_t from,
                              std::size_t to);

/// Returns for each sample whether it is at rest: no sample within 10 s, the reach of the decimation,
/// is shaken.  A sample with a missing axis (NaN) is never at rest; a missing shake counts as no
/// shaking.
[[nodiscard]] std::vector<bool> at_rest(std::span<const MotionSample> samples);

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
/// - between both it was handled, and its level changes by more than 0.005 deg or the norm by more than
///   10 mGal.
///
/// Cost: O(n).
/// Accuracy (moved_box_test.cpp): of 67 made-up stays each that end with a drive, a lift by 10 cm
/// and a kick of 0.05 deg, at least 95 % are found.  None of 200 stays with a lorry, knocks, and hands
/// that tilt the box by 0.001 deg has a move.  corrector/accuracy.md has simulated days.
/// @param samples  one in 2 s, in order of time; neither is checked.
/// @return none with fewer than 20 samples at rest.
[[nodiscard]] std::vector<BoxMove> find_box_moves(std::span<const MotionSample> samples);

}  // namespace a351::signal
