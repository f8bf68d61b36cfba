#include "daemon/believable/at_rest.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/believable/limits.hpp"

namespace a351::daemon::believable {

Motion motion_of(const Second& second, double g_per_count) {
    Motion motion;
    double square = 0.0, restlessness_g = 0.0;
    for (std::size_t i = 0; i < kAxisCount; ++i) {
        const Second::Range& axis = second.channels[i];
        const double mean_g = g_per_count * axis.mean;
        square += mean_g * mean_g;
        motion.largest_g = std::max(motion.largest_g, std::abs(mean_g));
        restlessness_g = std::max(
            restlessness_g, 0.5 * g_per_count * (static_cast<double>(axis.most) - axis.least));
    }
    motion.norm = StandardGravity(std::sqrt(square));
    motion.is_at_rest =
        restlessness_g <= kMostRestlessness * std::max(motion.norm, kLeastScale).value();
    return motion;
}

}  // namespace a351::daemon::believable
