#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "protocol/core/units.hpp"

namespace a351::daemon {

/// How the box stands against the day's first set-up.  Equal readings of the horizontal axes, not
/// level ones, keep what the axes' biases do to the norm the same everywhere.
struct Level {
    /// Of x and y, positive: its end stands higher than it did.
    std::array<double, 2> tilt_arcmin{};
    bool is_within = false;           ///< Of kMostTiltArcmin on both.
    std::vector<std::string> advice;  ///< "lower the +x side by 2.4'"; empty when within.
};

/// 0.02 deg: with 10 mg of bias of a horizontal axis 3.4 mGal in the norm.
inline constexpr double kMostTiltArcmin = 1.2;

/// An axis at rest reads +1 g when it points up, so the sine of its elevation in g:
/// tilt = asin(a) - asin(reference).  A sensor of the other sign would turn the advice round.
/// @param horizontal, reference  x and y; finite.
[[nodiscard]] Level level(const std::array<StandardGravity, 2>& horizontal,
                          const std::array<StandardGravity, 2>& reference);

}  // namespace a351::daemon
