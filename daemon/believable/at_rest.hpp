#pragma once

#include "daemon/believable/second.hpp"
#include "protocol/core/units.hpp"

namespace a351::daemon::believable {

/// Motion of a box in a second.
struct Motion {
    StandardGravity norm;     ///< Norm of the means of the axes.
    double largest_g = 0.0;   ///< Largest mean of an axis, without its sign.
    bool is_at_rest = false;  ///< No axis moves by more than kMostRestlessness.
};

[[nodiscard]] Motion motion_of(const Second& second, double g_per_count);

}  // namespace a351::daemon::believable
