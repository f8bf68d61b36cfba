#include "protocol/core/normal_gravity.hpp"

#include <cmath>
#include <numbers>

namespace a351 {
namespace {

// GRS80; Moritz 2000, section "Derived constants".
constexpr double kEquator_mgal = 978032.67715;       // gamma_e
constexpr double kSomigliana = 0.001931851353;       // k
constexpr double kEccentricity2 = 0.00669438002290;  // e^2
constexpr double kFlattening = 0.00335281068118;     // f
constexpr double kCentrifugal = 0.00344978600308;    // m = omega^2 a^2 b / GM
constexpr double kSemiMajorAxis_m = 6378137.0;       // a

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

}  // namespace a351
