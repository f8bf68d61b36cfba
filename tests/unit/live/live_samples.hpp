#pragma once

#include <cmath>
#include <cstdint>

#include "daemon/live/live_record.hpp"

namespace a351::daemon::live {

inline const UtcTime kZero = *parse_rfc3339("2026-03-14T08:00:00Z");
inline const wire::DeviceProfile& kProfile = *wire::find_profile("A351");

inline UtcTime after(double seconds) { return kZero + from_seconds(seconds); }

inline std::int32_t counts_of(double milligal) {
    return static_cast<std::int32_t>(
        std::lround(milligal / to_milligal(kProfile.acceleration(1)).value()));
}

/// Returns sample i of a series at 50 Hz, axes in mGal.
inline PlacedSample placed(std::int64_t i, double x, double y, double z) {
    constexpr std::int32_t kTemperatureCounts = -1981;  // 42.5 degC
    return {i,
            kZero + Nanoseconds(std::chrono::milliseconds(20)) * i,
            {counts_of(x), counts_of(y), counts_of(z), kTemperatureCounts}};
}

}  // namespace a351::daemon::live
