#pragma once

#include <optional>
#include <span>
#include <string>

#include "daemon/identify/fitting_profile.hpp"
#include "daemon/identify/report.hpp"
#include "protocol/wire/burst_frame.hpp"

namespace a351::daemon::identify {

struct TemperatureFinding {
    Verdict verdict = Verdict::unseen;
    std::string text;
    std::optional<Changes::Temperature> fits;  ///< The format that fits, if one does.
};

/// Compares the temperatures of frames with the formats of the family.
/// @param frames  at least one.
[[nodiscard]] TemperatureFinding temperature_of(std::span<const wire::BurstValues> frames,
                                                const wire::DeviceProfile& profile);

}  // namespace a351::daemon::identify
