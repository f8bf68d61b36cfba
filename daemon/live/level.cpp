#include "daemon/live/level.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace a351::daemon {
namespace {

constexpr double kArcminPerRadian = 60.0 * 180.0 / std::numbers::pi;

double elevation_arcmin(StandardGravity reading) {
    return kArcminPerRadian * std::asin(std::clamp(reading.value(), -1.0, 1.0));
}

}  // namespace

Level level(const std::array<StandardGravity, 2>& horizontal,
            const std::array<StandardGravity, 2>& reference) {
    Level level;
    level.is_within = true;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const double tilt = elevation_arcmin(horizontal[axis]) - elevation_arcmin(reference[axis]);
        level.tilt_arcmin[axis] = tilt;
        if (std::abs(tilt) <= kMostTiltArcmin) continue;
        level.is_within = false;
        char text[64];
        std::snprintf(text, sizeof text, "%s the +%c side by %.1f'", tilt > 0.0 ? "lower" : "raise",
                      axis == 0 ? 'x' : 'y', std::abs(tilt));
        level.advice.emplace_back(text);
    }
    return level;
}

}  // namespace a351::daemon
