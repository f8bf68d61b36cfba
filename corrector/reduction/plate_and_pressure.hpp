#pragma once
/// @file
/// Attraction of a plate of rock and air pressure of the standard atmosphere, by height.
///
///     const MilliGal bouguer = free_air - bouguer_plate(height, kCrust_kg_per_m3);
///
/// All functions are pure: they allocate nothing, throw nothing, and may be called from several
/// threads.  Ranges are not checked; NaN in any argument gives NaN.

#include "protocol/core/units.hpp"

namespace a351::corrector::reduction {

/// Mean density of the crust, kg/m3.  Source: the usual value of Bouguer anomalies, for example
/// W. J. Hinze et al., Geophysics 70(4), J25-J32, 2005.
inline constexpr double kCrust_kg_per_m3 = 2670.0;

/// Limits of a density of Bouguer anomalies, kg/m3.  Reason: ice has 917, and no rock of the crust
/// exceeds 3500; 2.67 would be another unit.
inline constexpr double kLeastDensity_kg_per_m3 = 500.0, kGreatestDensity_kg_per_m3 = 4000.0;

/// Returns the attraction of an infinite plate, 2 pi G density height, of the simple Bouguer
/// anomaly: 0.11197 mGal/m for kCrust_kg_per_m3.  It is negative below sea level.
///
/// Neither the Earth's curvature nor the terrain is included, which together are some mGal in
/// mountains.
/// Source of G, 6.67430e-11 m3/(kg s2): CODATA 2018.
/// @param height   above sea level.
/// @param density  kg/m3.
/// @return mGal.
[[nodiscard]] MilliGal bouguer_plate(Metres height, double density_kg_per_m3);

/// Returns the air pressure of the standard atmosphere, hPa:
///
///     p = 1013.25 (1 - 0.0065 h / 288.15)^5.2559
///
/// Accuracy (plate_and_pressure_test.cpp): within 0.02 hPa of the tables of the standard at 0, 1000 and
/// 3000 m.
/// Source: ISO 2533:1975, also DIN 5450; the reference of gravity's reduction for air pressure.
/// @param height  above sea level, -5000 (where it is 1778 hPa) to 11000 m.
[[nodiscard]] double normal_pressure_hpa(Metres height);

}  // namespace a351::corrector::reduction
