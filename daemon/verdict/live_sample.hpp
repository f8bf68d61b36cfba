#pragma once

#include <array>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::daemon::verdict {

/// Reach of the two decimations by ten on either side of a value, in s: 41 samples at 50 Hz and 41
/// at 5 Hz.
inline constexpr double kReachSeconds = 9.02;

/// Interval between values of the live series, s.
inline constexpr double kLiveStepSeconds = 2.0;

/// One value of the live 2 s series: the axes and the temperature, decimated as in a351-correct, so
/// that field and evening use the same values.  A missing value is NaN.
struct LiveSample {
    UtcTime time;     ///< Time of the values: the middle of the decimation filter.
    UtcTime seen_at;  ///< Time of the last raw sample in it: half a filter length later.
    std::array<MilliGal, 3> axes{};
    DegC temperature;
    /// Half the largest peak-to-peak value of an axis, from the raw samples of the 2 s before
    /// `seen_at`.  It shows a knock before the decimated axes do.
    MilliGal shake;
};

}  // namespace a351::daemon::verdict
