#pragma once
/// @file
/// From three axes to the magnitude of gravity.

#include "protocol/core/time_series.hpp"
#include "protocol/core/units.hpp"

namespace a351::corrector {

/// sqrt(x^2 + y^2 + z^2), NaN where an axis is.
/// @throws std::invalid_argument  the axes differ in start, rate or length.
[[nodiscard]] TimeSeries<StandardGravity> norm(const TimeSeries<StandardGravity>& x,
                                               const TimeSeries<StandardGravity>& y,
                                               const TimeSeries<StandardGravity>& z);

/// How much the mean of a norm of raw samples exceeds gravity, to second order in the vibration:
///
///     (sx^2 + sy^2) / (2 g)      1 Gal rms on both axes: 1.02 mGal
///
/// @param rms_x, rms_y  Rms of the horizontal axes about their trend.
/// @param gravity       > 0
[[nodiscard]] MilliGal rectification_bias(MilliGal rms_x, MilliGal rms_y, MilliGal gravity);

}  // namespace a351::corrector
