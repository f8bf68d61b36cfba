#pragma once
/// @file
/// Tilt of a horizontal axis, from the acceleration of the three axes at rest.
///
///     if (const auto axis = tilt_axis("tilt-x")) show(tilt_urad({x, y, z}, *axis));

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace a351::corrector::archive_series {

/// Returns the number of the axis whose tilt has this name: 0 for tilt-x, 1 for tilt-y, no number for
/// any other quantity or channel.
[[nodiscard]] constexpr std::optional<std::size_t> tilt_axis(std::string_view name) {
    if (name == "tilt-x") return 0;
    if (name == "tilt-y") return 1;
    return std::nullopt;
}

/// Returns the angle between an axis and the horizontal plane, urad; positive if the positive end of
/// the axis points upward, where it measures a part of 1 g:
///
///     tilt_x = 1e6 atan2(x, sqrt(y^2 + z^2)) = 1e6 asin(x / norm)
///
/// It is exact at any angle, and needs neither the value of gravity nor the scale.  The small-angle
/// form 1e6 x / norm is lower by tilt^3 / 6: 0.17 urad at 10 mrad, 885 urad at 10 deg.
/// The bias of the axis is in it, 1 urad per 0.98 mGal, so that only changes have a meaning.
/// @param axes  x, y, z at rest, any common unit, not all 0.  NaN gives NaN.
[[nodiscard]] inline double tilt_urad(const std::array<double, 3>& axes, std::size_t axis) {
    constexpr double kUradPerRad = 1e6;
    const double along = axes.at(axis);
    return kUradPerRad *
           std::atan2(along, std::hypot(axes.at((axis + 1) % 3), axes.at((axis + 2) % 3)));
}

/// Refuses an axis that is not horizontal: the median of its tilts is beyond 45 deg.
/// @param tilts_urad  finite; none are accepted.
/// @param option      option that asks for the tilt, for the message.
/// @throws InputError
void require_horizontal(std::vector<double> tilts_urad, std::size_t axis, std::string_view option);

}  // namespace a351::corrector::archive_series
