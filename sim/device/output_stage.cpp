#include "sim/device/output_stage.hpp"

#include <algorithm>
#include <cmath>

namespace a351::sim {

LimitedAxis limited_axis(std::int32_t counts, const AxisSettings& settings,
                         const wire::DeviceProfile& profile) noexcept {
    const std::int64_t one_g = std::int64_t{1} << profile.acceleration_fraction_bits;
    const std::int64_t upper = settings.upper_limit_g * one_g;
    const std::int64_t lower = settings.lower_limit_g * one_g;
    const std::int64_t sum = std::int64_t{counts} + settings.offset_counts;
    // Not std::clamp: the host may set the lower limit above the upper.
    return {static_cast<std::int32_t>(std::min(std::max(sum, lower), upper)),
            sum > upper || sum < lower};
}

std::int32_t tilt_counts(std::int32_t acceleration_counts,
                         const wire::DeviceProfile& profile) noexcept {
    const double sine = std::clamp(profile.acceleration(acceleration_counts).value(), -1.0, 1.0);
    const double counts = std::round(std::ldexp(std::asin(sine), profile.tilt_fraction_bits));
    return std::clamp(static_cast<std::int32_t>(counts), -kLargestTiltCounts, kLargestTiltCounts);
}

}  // namespace a351::sim
