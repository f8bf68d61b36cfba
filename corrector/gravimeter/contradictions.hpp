#pragma once
/// @file
/// Contradictions of a file in itself: tide, positions, stay numbers, tide correction.
///
///     for (const text::Message& remark : contradictions(file, tide_of)) warn(remark);

#include <vector>

#include "corrector/gravimeter/gravimeter_file.hpp"
#include "corrector/tide/tide_check.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::gravimeter {

/// Limits, above which a difference is named.
/// m: a receiver without corrections is within 10 m, and its height within 10 m most of the time.
inline constexpr double kGreatestDistance_m = 100.0, kGreatestHeightDifference_m = 10.0;

/// Returns the contradictions of a file, one sentence each with the size of its effect and what is
/// used:
///
/// 1. The tide in the file differs from the computed one, or is 0 throughout (find_doubt() with
///    kTideOfInstrument).
/// 2. Positions of one station differ, or the receiver is elsewhere than the position entered.
/// 3. A stay number comes back at its station after other stations.
/// 4. The tide correction is on for some readings and off for others.
[[nodiscard]] std::vector<text::Message> contradictions(const GravimeterFile& file,
                                                        const tide::TideOf& tide_of);

}  // namespace a351::corrector::gravimeter
