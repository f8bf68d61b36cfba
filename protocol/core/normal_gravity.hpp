#pragma once
/// @file
/// Gravity of the normal Earth, with which measured values are compared.
///
///     const MilliGal free_air_anomaly = gravity - normal_gravity(latitude, height);
///
/// The functions are pure: they allocate nothing, throw nothing, and may be called from several
/// threads.  Ranges are not checked; NaN in any argument gives NaN.

#include "protocol/core/units.hpp"

namespace a351 {

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

}  // namespace a351
