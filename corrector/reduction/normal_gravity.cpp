#include "corrector/reduction/normal_gravity.hpp"

#include <cmath>
#include <numbers>

namespace a351::corrector::reduction {
namespace {

// GRS80; Moritz 2000, section "Derived constants".
constexpr double kEquator_mgal = 978032.67715;       // gamma_e
constexpr double kSomigliana = 0.001931851353;       // k
constexpr double kEccentricity2 = 0.00669438002290;  // e^2
constexpr double kFlattening = 0.00335281068118;     // f
constexpr double kCentrifugal = 0.00344978600308;    // m = omega^2 a^2 b / GM
constexpr double kSemiMajorAxis_m = 6378137.0;       // a

constexpr double kGravitation = 6.67430e-11;  // m3/(kg s2), CODATA 2018
constexpr double kMilliGalPerSi = 1e5;

double sine_squared(Degrees latitude) {
    const double sine = std::sin(latitude.value() / 180.0 * std::numbers::pi);
    return sine * sine;
}

}  // namespace

MilliGal normal_gravity(Degrees latitude) {
    const double s2 = sine_squared(latitude);
    return MilliGal(kEquator_mgal * (1.0 + kSomigliana * s2) /
                    std::sqrt(1.0 - kEccentricity2 * s2));
}

MilliGal normal_gravity(Degrees latitude, Metres height) {
    const double ratio = height.value() / kSemiMajorAxis_m;
    const double linear =
        2.0 * (1.0 + kFlattening + kCentrifugal - 2.0 * kFlattening * sine_squared(latitude));
    return MilliGal(normal_gravity(latitude).value() *
                    (1.0 - linear * ratio + 3.0 * ratio * ratio));
}

MilliGal bouguer_plate(Metres height, double density_kg_per_m3) {
    return MilliGal(2.0 * std::numbers::pi * kGravitation * density_kg_per_m3 * height.value() *
                    kMilliGalPerSi);
}

double normal_pressure_hpa(Metres height) {
    // Sea level 1013.25 hPa and 288.15 K, lapse rate 0.0065 K/m; exponent g M / (R L).
    return 1013.25 * std::pow(1.0 - 0.0065 * height.value() / 288.15, 5.2559);
}

}  // namespace a351::corrector::reduction
