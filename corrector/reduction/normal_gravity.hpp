#pragma once
/// @file
/// Gravity, attraction and air pressure of the normal Earth: what a measured value is compared with.
///
///     const MilliGal free_air = gravity - normal_gravity(latitude, height);
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

/// Returns the gravity of the ellipsoid GRS80 on its surface, by the closed formula of Somigliana:
///
///     gamma = gamma_e (1 + k s^2) / sqrt(1 - e^2 s^2),   s = sin(latitude)
///
/// Accuracy (normal_gravity_test.cpp): the last digit of the published values at the equator, at
/// 45 degrees and at the pole, and within 0.00001 mGal of the gradient of the exact potential at
/// any latitude.
/// Source: H. Moritz, Geodetic Reference System 1980, J. Geod. 74, 128-133, 2000.
/// @param latitude  geodetic, -90 to 90 degrees; other angles are taken as periodic.
/// @return mGal, 978032.67715 at the equator to 983218.63685 at a pole.
[[nodiscard]] MilliGal normal_gravity(Degrees latitude);

/// Returns the gravity of GRS80 above the ellipsoid, to the second order of the height:
///
///     gamma_h = gamma [1 - 2 (1 + f + m - 2 f s^2) h/a + 3 (h/a)^2]
///
/// At 45 degrees it decreases by 0.3086 mGal/m.  For anomalies the height above sea level is used
/// in place of that above the ellipsoid.
///
/// Accuracy (normal_gravity_test.cpp): against the gradient of the exact potential at any latitude
/// within 0.011 mGal from -500 to 1000 m, 0.03 mGal at 3000 m, and 0.07 mGal at 9000 m.
/// Source: W. A. Heiskanen and H. Moritz, Physical Geodesy, Freeman 1967, eq. 2-123.
/// @param latitude  as normal_gravity().
/// @param height    -500 to 9000 m.
/// @return mGal.
[[nodiscard]] MilliGal normal_gravity(Degrees latitude, Metres height);

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
/// Accuracy (normal_gravity_test.cpp): within 0.02 hPa of the tables of the standard at 0, 1000 and
/// 3000 m.
/// Source: ISO 2533:1975, also DIN 5450; the reference of gravity's reduction for air pressure.
/// @param height  above sea level, -500 to 11000 m.
[[nodiscard]] double normal_pressure_hpa(Metres height);

}  // namespace a351::corrector::reduction
