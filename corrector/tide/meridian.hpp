#pragma once

#include <cmath>

#include "corrector/tide/earth_tide.hpp"

namespace a351::corrector::tide {

/// Semi-major axis (m) and flattening of the WGS84 ellipsoid.  Source: NIMA TR8350.2, table 3.1.
inline constexpr double kEquatorialRadius_m = 6378137.0;
inline constexpr double kFlattening = 1.0 / 298.257223563;

/// Position in the meridian of a station.
struct Meridian {
    double rho_m = 0.0;  ///< Distance from the Earth's axis.
    double z_m = 0.0;    ///< Distance from the plane of the equator, north positive.
};

/// Returns the position from sine and cosine of the geodetic latitude and the height:
/// N = a / sqrt(1 - e^2 sin^2 lat), rho = (N + h) cos lat, z = (N (1 - e^2) + h) sin lat.
inline Meridian meridian(double sin_lat, double cos_lat, double height_m) {
    const double e2 = kFlattening * (2.0 - kFlattening);
    const double n_m = kEquatorialRadius_m / std::sqrt(1.0 - e2 * sin_lat * sin_lat);
    return {(n_m + height_m) * cos_lat, (n_m * (1.0 - e2) + height_m) * sin_lat};
}

}  // namespace a351::corrector::tide
