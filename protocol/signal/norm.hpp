#pragma once
/// @file
/// Magnitude of gravity from three axes.

#include "protocol/core/time_series.hpp"
#include "protocol/core/units.hpp"

namespace a351::corrector {

/// Returns the norm of three axes, sample by sample:
///
///     sqrt(x^2 + y^2 + z^2)
///
/// Missing values: the norm is NaN if an axis is NaN.  Components above 7e153 in magnitude may
/// overflow to infinity.
///
/// Accuracy: rounding; the norm of (0.6, 0, 0.8) is 1 to 1e-15, however the axes point
/// (norm_test.cpp).
///
/// @param x, y, z  acceleration in g, (n) each, n >= 0, on the same grid.
/// @return the norm in g, (n), with the start and rate of the axes.
/// @throws std::invalid_argument  the axes differ in start, rate or length.
[[nodiscard]] TimeSeries<StandardGravity> norm(const TimeSeries<StandardGravity>& x,
                                               const TimeSeries<StandardGravity>& y,
                                               const TimeSeries<StandardGravity>& z);

/// Returns the excess of the mean norm of raw samples over gravity, to second order in the
/// vibration:
///
///     (sx^2 + sy^2) / (2 g)      1 Gal rms on both axes: 1.02 mGal
///
/// A NaN argument gives NaN.
///
/// Accuracy: within 1e-3 of the excess on simulated vibration of 1 and 2 Gal rms
/// (decimated_axes_test.cpp).
///
/// @param rms_x, rms_y  rms of the horizontal axes about their trend, mGal.
/// @param gravity       mGal, > 0; not checked, 0 gives infinity or NaN.
[[nodiscard]] MilliGal rectification_bias(MilliGal rms_x, MilliGal rms_y, MilliGal gravity);

}  // namespace a351::corrector
