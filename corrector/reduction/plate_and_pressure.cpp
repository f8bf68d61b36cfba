#include "corrector/reduction/plate_and_pressure.hpp"

#include <cmath>
#include <numbers>

namespace a351::corrector::reduction {
namespace {

constexpr double kGravitation = 6.67430e-11;  // m3/(kg s2), CODATA 2018
constexpr double kMilliGalPerSi = 1e5;

}  // namespace

MilliGal bouguer_plate(Metres height, double density_kg_per_m3) {
    return MilliGal(2.0 * std::numbers::pi * kGravitation * density_kg_per_m3 * height.value() *
                    kMilliGalPerSi);
}

double normal_pressure_hpa(Metres height) {
    // Sea level 1013.25 hPa and 288.15 K, lapse rate 0.0065 K/m; exponent g M / (R L).
    return 1013.25 * std::pow(1.0 - 0.0065 * height.value() / 288.15, 5.2559);
}

}  // namespace a351::corrector::reduction
