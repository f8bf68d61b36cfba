#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "protocol/core/units.hpp"

namespace a351::daemon {

/// The tilt of the box relative to the day's first set-up.  If the horizontal axes read the same at
/// each set-up, level or not, the effect of their biases on the norm is the same everywhere.
struct Level {
    /// Tilt of x and y; positive if the + end is higher than at the first set-up.
    std::array<double, 2> tilt_arcmin{};
    bool is_within = false;           ///< Both are within kMostTiltArcmin.
    std::vector<std::string> advice;  ///< "lower the +x side by 2.4'"; empty if within.
};

/// Limit of the tilt in arc minutes, 0.02 deg.  With 10 mg bias of a horizontal axis it changes the
/// norm by 3.4 mGal.
inline constexpr double kMostTiltArcmin = 1.2;

/// Computes the tilt: asin(a) - asin(reference).  An axis at rest that points up reads +1 g, so its
/// reading in g is the sine of its elevation.  For a sensor of opposite sign the advice reverses.
/// @param horizontal, reference  x and y; finite.
[[nodiscard]] Level level(const std::array<StandardGravity, 2>& horizontal,
                          const std::array<StandardGravity, 2>& reference);

}  // namespace a351::daemon
