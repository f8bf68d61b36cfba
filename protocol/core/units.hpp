#pragma once
/// @file
/// Physical quantities as types.  A unit mismatch does not compile; a conversion has a name.
///
/// Use them for scalars that cross a header.  Inside a computation use plain doubles whose names
/// end with the unit: `_mgal _degc _s _hz _counts`.
///
///     const MilliGal step = second - first;
///     const MilliGal half = 0.5 * step;        // the number is on the left
///     const double step_mgal = step.value();   // the way out of the type
///
/// No operator makes another unit: a product of two quantities does not compile
/// (tests/compile_fail), and a quotient neither.  Divide their values instead.

#include <compare>
#include <numbers>

namespace a351 {

/// A number with a unit.  Explicit to build, explicit to read, arithmetic only within the unit.
///
/// The arithmetic is that of double: nothing is checked or thrown, and NaN gives NaN.
/// @tparam Unit  a type that only makes this unit different from others; it is never defined.
template <class Unit>
class Quantity {
public:
    /// Makes the quantity 0.
    constexpr Quantity() = default;
    /// Makes a quantity from a number in this unit.
    /// @param value  any double; also NaN and infinity, which are kept.
    constexpr explicit Quantity(double value) noexcept : value_(value) {}

    /// Returns the number in this unit.
    [[nodiscard]] constexpr double value() const noexcept { return value_; }

    /// Compares the numbers exactly, without a tolerance.  Every comparison with NaN is false,
    /// except `!=`.
    constexpr auto operator<=>(const Quantity&) const = default;
    /// Returns the quantity with the other sign.
    constexpr Quantity operator-() const noexcept { return Quantity(-value_); }
    /// Returns the sum.  The sum of two temperatures in degC is seldom meant: use a difference.
    friend constexpr Quantity operator+(Quantity a, Quantity b) noexcept {
        return Quantity(a.value_ + b.value_);
    }
    /// Returns a minus b.
    friend constexpr Quantity operator-(Quantity a, Quantity b) noexcept {
        return Quantity(a.value_ - b.value_);
    }
    /// Returns the multiple of a.  The factor has no unit and is on the left.
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
/// Length, height or altitude in metres.
using Metres = Quantity<struct MetresUnit>;
using Degrees = Quantity<struct DegreesUnit>;  ///< Angle; latitude north, longitude east.

/// Lengths of a minute and of an hour, s.
inline constexpr double kSecondsPerMinute = 60.0, kSecondsPerHour = 3600.0;
/// Radians per degree, pi / 180, for the functions of <cmath>.
inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;
/// Degrees per radian, 180 / pi.
inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;

/// Milligals per Gal (1 Gal = 1 cm/s2) and per m/s2, both exact.
inline constexpr double kMilliGalPerGal = 1000.0, kMilliGalPerMps2 = 1e5;

/// Standard gravity, 3rd CGPM 1901: 9.80665 m/s2, exactly.
inline constexpr double kMilliGalPerStandardGravity = 980665.0;

/// Returns an acceleration in mGal: 980665 times its value in g.  The product is rounded once: by
/// less than 1e-10 mGal near 1 g.  NaN gives NaN.
[[nodiscard]] constexpr MilliGal to_milligal(StandardGravity g) noexcept {
    return MilliGal(g.value() * kMilliGalPerStandardGravity);
}
/// Returns an acceleration in g: the value in mGal divided by 980665, rounded once.  NaN gives NaN.
[[nodiscard]] constexpr StandardGravity to_standard_gravity(MilliGal a) noexcept {
    return StandardGravity(a.value() / kMilliGalPerStandardGravity);
}

}  // namespace a351
