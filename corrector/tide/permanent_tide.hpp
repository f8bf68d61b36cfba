#pragma once
/// @file
/// The permanent part of the tide, and the systems of gravity that differ by it.
///
/// Moon and Sun pull on the average too: gravity is lower at the equator and higher at the poles,
/// and the elastic Earth is deformed for ever.  What a value of gravity contains of this is its
/// tide system.

#include <optional>
#include <string_view>

#include "corrector/tide/earth_tide.hpp"

namespace a351::corrector::tide {

/// Returns the permanent tide of a rigid Earth along the normal of the ellipsoid:
///
///     V = -K (r/a)^2 P_2(sin psi) = -K (z^2 - rho^2 / 2) / a^2
///     permanent tide = -dV/dn = K (2 z sin lat - rho cos lat) / a^2
///
/// psi is the geocentric latitude, rho and z the distances from the Earth's axis and equator.
///
/// Accuracy: within 0.00002 mGal of ETERNA's catalogue at 20 places, within 0.0002 mGal of -0.0304 + 0.0912 sin^2(lat) mGal (M. Ekman, Bull. Geod. 63,
/// 281-296, 1989) and of the mean of direct_tide() over 18.6 years (tide_system_test.cpp).
/// Source of K: permanent_tide.cpp.
/// @return mGal, positive if gravity is larger: -0.030 at the equator, +0.061 at the poles.
[[nodiscard]] MilliGal permanent_tide(const Station& station);

/// Returns the part of the permanent tide that is not subtracted in a system:
/// 0 for tide-free, (delta2 - 1) times the permanent tide for zero, delta2 times it for mean.
[[nodiscard]] MilliGal kept_permanent_tide(System system, const Station& station, Factors factors);

/// Returns the name of a system: tide-free, zero or mean.
[[nodiscard]] std::string_view name_of(System system);

/// Returns the system of that name, or std::nullopt.
[[nodiscard]] std::optional<System> system_named(std::string_view name);

}  // namespace a351::corrector::tide
