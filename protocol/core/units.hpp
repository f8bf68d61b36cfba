#pragma once
/// @file
/// Physical quantities as types.  A unit mismatch does not compile; a conversion has a name.

#include <compare>
#include <numbers>

namespace a351 {

/// A number with a unit.  Explicit to build, explicit to read, arithmetic only within the unit.
template <class Unit>
class Quantity {
public:
    constexpr Quantity() = default;
    constexpr explicit Quantity(double value) noexcept : value_(value) {}

    [[nodiscard]] constexpr double value() const noexcept { return value_; }

    constexpr auto operator<=>(const Quantity&) const = default;
    constexpr Quantity operator-() const noexcept { return Quantity(-value_); }
    friend constexpr Quantity operator+(Quantity a, Quantity b) noexcept {
        return Quantity(a.value_ + b.value_);
    }
    friend constexpr Quantity operator-(Quantity a, Quantity b) noexcept {
        return Quantity(a.value_ - b.value_);
    }
    friend constexpr Quantity operator*(double factor, Quantity a) noexcept {
        return Quantity(factor * a.value_);
    }

private:
    double value_ = 0.0;
};

using MilliGal = Quantity<struct MilliGalUnit>;                ///< 1 mGal = 1e-5 m/s2.
using StandardGravity = Quantity<struct StandardGravityUnit>;  ///< 1 g = 9.80665 m/s2 exactly.
using DegC = Quantity<struct DegCUnit>;                        ///< Degrees Celsius.
using Percent = Quantity<struct PercentUnit>;                  ///< Share of full drive or scale.
using Hertz = Quantity<struct HertzUnit>;                      ///< Events or samples per second.
using Metres = Quantity<struct MetresUnit>;
using Degrees = Quantity<struct DegreesUnit>;  ///< Angle; latitude north, longitude east.

inline constexpr double kSecondsPerMinute = 60.0, kSecondsPerHour = 3600.0;
inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;
inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;

inline constexpr double kMilliGalPerGal = 1000.0, kMilliGalPerMps2 = 1e5;

/// Standard gravity, 3rd CGPM 1901: 9.80665 m/s2, exactly.
inline constexpr double kMilliGalPerStandardGravity = 980665.0;

[[nodiscard]] constexpr MilliGal to_milligal(StandardGravity g) noexcept {
    return MilliGal(g.value() * kMilliGalPerStandardGravity);
}
[[nodiscard]] constexpr StandardGravity to_standard_gravity(MilliGal a) noexcept {
    return StandardGravity(a.value() / kMilliGalPerStandardGravity);
}

}  // namespace a351
