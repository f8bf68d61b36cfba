#pragma once

#include <array>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::daemon {

/// How far the two decimations by ten reach beyond a value on either side: 41 samples at 50 Hz and
/// 41 at 5 Hz.
inline constexpr double kReachSeconds = 9.02;

/// Interval between values of the live series, s.
inline constexpr double kLiveStepSeconds = 2.0;

/// One value of the live 2 s series: the axes and the temperature through the decimation of the
/// evening, so that field and evening see the same.  A value that is missing is NaN.
struct LiveSample {
    UtcTime time;     ///< Of the values: the middle of the decimation filter.
    UtcTime seen_at;  ///< Of the last raw sample that went into it: half a filter later.
    std::array<MilliGal, 3> axes{};
    DegC temperature;
    /// Half the largest peak to peak of an axis of the raw samples of the 2 s before `seen_at`: a
    /// knock is seen there before the decimated axes show it.
    MilliGal shake;
};

}  // namespace a351::daemon
