#include "daemon/identify/temperature.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "daemon/believable/temperature_format.hpp"

namespace a351::daemon::identify {
namespace {

// Temperature that a room, a box and an oven are around.  Of several possible formats the one nearest
// to it fits: two formats are as near only at 7 degC.
constexpr double kUsual_degc = 30.0;

double distance_degc(const believable::TemperatureCandidate& candidate) {
    return std::abs(candidate.temperature.value() - kUsual_degc);
}

}  // namespace

TemperatureFinding temperature_of(std::span<const wire::BurstValues> frames,
                                  const wire::DeviceProfile& profile) {
    std::vector<std::int32_t> counts;
    for (const wire::BurstValues& frame : frames) counts.push_back(frame.temperature);
    const auto candidates = believable::temperature_candidates(counts);
    std::string text = "in each format of the family:";
    const believable::TemperatureCandidate* fits = nullptr;
    for (const auto& candidate : candidates) {
        text += fmt::format("{} {:.2f} degC ({})", &candidate == &candidates.front() ? "" : ",",
                            candidate.temperature.value(), candidate.format->name);
        if (candidate.is_possible &&
            (fits == nullptr || distance_degc(candidate) < distance_degc(*fits)))
            fits = &candidate;
    }
    if (fits == nullptr) return {Verdict::differs, text + "; none of them is possible", {}};
    const believable::TemperatureFormat& format = *fits->format;
    if (format.is_that_of(profile)) {
        return {
            Verdict::confirmed, fmt::format("profile {}: {}", profile.name, text),
            Changes::Temperature{profile.temperature_slope_degc, profile.temperature_offset_degc}};
    }
    return {Verdict::differs, fmt::format("{}; the format that fits is: {}", text, format.name),
            Changes::Temperature{format.slope_degc, format.offset_degc}};
}

}  // namespace a351::daemon::identify
