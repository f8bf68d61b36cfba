#include "corrector/tide/permanent_tide.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "corrector/tide/meridian.hpp"

namespace a351::corrector::tide {
namespace {

/// Amplitude of the permanent potential, m2/s2: (GM/a) A_0 |H_0| sqrt(5) with GM/a = 3.986004418e14
/// / 6378136.6 m2/s2, A_0 = 1 / (a sqrt(4 pi)) and H_0 = -0.31460 m, the amplitude of the permanent
/// tide.  Source: IERS Conventions (2010), Technical Note 36, section 6.2.2 and tables 1.1, 6.5b.
constexpr double kPotential_m2ps2 = 1.94440;

constexpr std::array<std::pair<System, std::string_view>, 3> kSystems{
    {{System::tide_free, "tide-free"}, {System::zero, "zero"}, {System::mean, "mean"}}};

}  // namespace

MilliGal permanent_tide(const Station& station) {
    const double latitude = station.latitude.value() * kRadPerDeg;
    const double sine = std::sin(latitude), cosine = std::cos(latitude);
    const auto [rho_m, z_m] = meridian(sine, cosine, station.height.value());
    return MilliGal(kMilliGalPerMps2 * kPotential_m2ps2 * (2.0 * z_m * sine - rho_m * cosine) /
                    (kEquatorialRadius_m * kEquatorialRadius_m));
}

MilliGal kept_permanent_tide(System system, const Station& station, Factors factors) {
    if (system == System::tide_free) return MilliGal(0.0);
    return (factors.delta2 - (system == System::zero ? 1.0 : 0.0)) * permanent_tide(station);
}

std::string_view name_of(System system) {
    return std::ranges::find(kSystems, system, &decltype(kSystems)::value_type::first)->second;
}

std::optional<System> system_named(std::string_view name) {
    const auto* const found =
        std::ranges::find(kSystems, name, &decltype(kSystems)::value_type::second);
    return found == kSystems.end() ? std::nullopt : std::optional(found->first);
}

}  // namespace a351::corrector::tide
