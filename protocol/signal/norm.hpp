#pragma once
/// @file
/// Magnitude of gravity from three axes, and the excess that vibration causes.
///
/// The norm of ideal axes does not depend on how the sensor is turned.  Decimate the axes first:
/// the norm of raw samples includes the excess of rectification_bias().

#include "protocol/core/time_series.hpp"
#include "protocol/core/units.hpp"

namespace a351::signal {

/// Returns the norm of three axes, sample by sample:
///
///     sqrt(x^2 + y^2 + z^2)
///
/// Missing values: the norm is NaN if an axis is NaN.  Components above 7e153 in magnitude may
/// overflow to infinity.  The order of the axes does not matter, except for rounding.
///
/// Cost: O(n); allocates the result only.
///
/// Accuracy: rounding; the norm of (0.6, 0, 0.8) is 1 to 1e-15, however the axes point
/// (norm_test.cpp).
///
/// @param x, y, z  acceleration in g, (n) each, n >= 0, on the same grid.
/// @return the norm in g, (n), with the start and rate of the axes.
/// @throws std::invalid_argument  the axes differ in start (even by 1 ns), rate or length.
[[nodiscard]] TimeSeries<StandardGravity> norm(const TimeSeries<StandardGravity>& x,
                                               const TimeSeries<StandardGravity>& y,
                                               const TimeSeries<StandardGravity>& z);

/// Returns the excess of the mean norm of raw samples over gravity, to second order in the
/// vibration:
///
///     (sx^2 + sy^2) / (2 g)      1 Gal rms on both axes: 1.02 mGal
///
/// A NaN argument gives NaN.  The result is positive: subtract it from the mean norm.  It grows
/// with the square of the vibration, so it is small for a quiet site.
///
/// Use it to judge a norm of raw samples.  A norm of decimated axes is free of the excess to 1e-4
/// mGal at 1 Gal rms (decimated_axes_test.cpp).
///
/// Accuracy: within 1e-3 of the excess on simulated vibration of 1 and 2 Gal rms
/// (decimated_axes_test.cpp).
///
/// @param rms_x, rms_y  rms of the horizontal axes about their trend, mGal; the sign is ignored.
/// @param gravity       mGal, > 0; not checked, 0 gives infinity or NaN.
/// @return the excess in mGal, >= 0.
[[nodiscard]] MilliGal rectification_bias(MilliGal rms_x, MilliGal rms_y, MilliGal gravity);

}  // namespace a351::signal
