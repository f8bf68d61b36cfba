#pragma once
/// @file
/// Steps of the emulated sensor between filter and output: the user's offset, alarm limits, tilt.
/// M-A352AD10 data sheet, rev. 20251023, 5.8, 5.12, 5.13, 7.7, 7.8, 7.21-7.26.

#include <cstdint>

#include "protocol/wire/device_profile.hpp"

namespace a351::sim {

struct AxisSettings {
    std::int32_t offset_counts = 0;  ///< Offset to add, in the format of the acceleration.
    std::int8_t upper_limit_g = 15;
    std::int8_t lower_limit_g = -15;
};

struct LimitedAxis {
    std::int32_t acceleration_counts = 0;  ///< Limited to the two limits.
    bool is_alarmed = false;               ///< The value was beyond a limit, not just at it.
};

/// Returns counts + offset, kept within the limits.
[[nodiscard]] LimitedAxis limited_axis(std::int32_t counts, const AxisSettings& settings,
                                       const wire::DeviceProfile& profile) noexcept;

/// Tilt of +60 degrees, in counts as the device sends it (7.8).
inline constexpr std::int32_t kLargestTiltCounts = 0x2182A470;

/// Returns asin(acceleration / 1 g), limited to +-60 degrees.
[[nodiscard]] std::int32_t tilt_counts(std::int32_t acceleration_counts,
                                       const wire::DeviceProfile& profile) noexcept;

}  // namespace a351::sim
