#pragma once
/// @file
/// Limits of what a working sensor sends, if its profile is right.  Recorder and corrector use these.

#include "protocol/core/units.hpp"

namespace a351 {

/// Limits of the norm of a box at rest.  Gravity on Earth is 0.997 to 1.003 g (9.78 to 9.83 m/s2:
/// WGS 84).  The bias of an axis is 7 mg at most after a year: M-A352AD10 data sheet rev. 20251023,
/// electrical characteristics (2 mg at first, 3 mg in a year, 2 mg over temperature).  The margin of
/// ten is for an older unit; the nearest wrong scale is 0.5.
inline constexpr StandardGravity kLeastNorm(0.9), kMostNorm(1.1);

/// Returns true if a box at rest can have this norm.  NaN: false.
[[nodiscard]] constexpr bool is_norm_believable(StandardGravity norm) noexcept {
    return norm >= kLeastNorm && norm <= kMostNorm;
}

/// Limits of the temperature.  The family is rated for -30 to +85 degC: M-A352AD10 data sheet rev.
/// 20251023, maximum ratings.  The rest is the error of its thermometer, "a reference value" (7.6).
inline constexpr DegC kColdest(-40.0), kHottest(90.0);

/// Returns true if the sensor can have this temperature.  NaN: false.
[[nodiscard]] constexpr bool is_temperature_believable(DegC temperature) noexcept {
    return temperature >= kColdest && temperature <= kHottest;
}

/// Largest relative error of the sample rate.  A crystal clock is within 0.0001, and a declared rate
/// must be within 0.001 (a351d.toml(5)); the nearest wrong rate is 2 times.
inline constexpr double kMostRateError = 0.005;

}  // namespace a351
