#pragma once
/// @file
/// Is a tide that came with readings the tide of their times and places?
///
///     if (const auto doubt = find_doubt(tides, kTideOfAnyTable, usual_tide))
///         warn(doubt->size_mgal, tides[doubt->index], doubt->remedy);

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "corrector/tide/earth_tide.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::tide {

/// Computes the effect of the tide on gravity.
using TideOf = std::function<MilliGal(UtcTime, const Station&)>;

/// Returns direct_tide() with its usual factors.
[[nodiscard]] MilliGal usual_tide(UtcTime time, const Station& station);

/// The tide that is used for a reading, as effect on gravity, and where it was read.
struct UsedTide {
    UtcTime time;
    Station station;
    double tide_mgal = 0.0;
};

/// How well a tide has to agree with the computed one.
struct Agreement {
    double most_mgal;        ///< Largest difference.
    bool is_constant_known;  ///< False: the mean difference is left out; the tide must vary then.
};

/// Models and factors of the instruments differ by up to 0.005 mGal (gravimeter-format.md), and a tide
/// of another hour by more than 0.02 within a few readings.
inline constexpr Agreement kTideOfInstrument{0.01, true};
/// Chosen: three times the limit of the instruments, with room for ocean loading.  The permanent tide
/// of a table is not known.  The tide of another sign or of some hours later differs by 0.07 to 0.2
/// mGal.
inline constexpr Agreement kTideOfAnyTable{0.03, false};

/// A tide that does not agree with the computed one.
struct Doubt {
    std::size_t index = 0;        ///< The tide that differs most.
    double size_mgal = 0.0;       ///< Its difference; positive.
    bool is_zero = false;         ///< The tide is 0 throughout.
    bool has_other_sign = false;  ///< The tide agrees with the other sign.
    /// The end of a sentence.  It names what makes the tides agree: a shift of the times by half
    /// hours, up to a day, or the other sign of the tide or of a coordinate.  Empty if nothing of this
    /// does, if shifts more than an hour apart fit nearly as well, or if the tide varies by less than
    /// 0.05 mGal.  With ocean loading of 0.02 mGal the hours may be wrong.
    text::Message remedy = {};
};

/// Compares tides with the computed ones.
/// @param tides  may be empty.
/// @return absent if they agree.
[[nodiscard]] std::optional<Doubt> find_doubt(const std::vector<UsedTide>& tides,
                                              const Agreement& agreement, const TideOf& tide_of);

}  // namespace a351::corrector::tide
