#include "daemon/believable/temperature_format.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "daemon/believable/limits.hpp"

namespace a351::daemon::believable {
namespace {

constexpr double kSlope_degc = -0.0037918, kOffset_degc = 34.987;
constexpr double kShifted = 65536.0;

constexpr std::array kFormats{
    TemperatureFormat{"slope and offset", kSlope_degc, kOffset_degc, 32,
                      "M-A352AD10 data sheet, rev. 20251023, 7.6"},
    TemperatureFormat{"slope and offset, counts x 65536", kSlope_degc / kShifted, kOffset_degc, 32,
                      "M-G362 data sheet, 2013: a 32-bit value is the 16-bit value x 65536"},
    TemperatureFormat{"1/1024 degC", 1.0 / 1024.0, 0.0, 32,
                      "keisukesakasai/ma550ac d46f5c0, tpdo4.conf: int32 / 2^10 of an M-A550AC"},
};

bool is_shifted(const TemperatureFormat& format) {
    return format.slope_degc == kSlope_degc / kShifted;
}

}  // namespace

std::string TemperatureFormat::toml() const {
    return fmt::format("slope_degc = {}\noffset_degc = {:.3f}\nwidth_bits = {}\n", slope_degc,
                       offset_degc, width_bits);
}

bool TemperatureFormat::is_that_of(const wire::DeviceProfile& profile) const noexcept {
    constexpr double kNear = 0.01;  // of the slope; 1 degC of the offset
    return std::abs(profile.temperature_slope_degc - slope_degc) < kNear * std::abs(slope_degc) &&
           std::abs(profile.temperature_offset_degc - offset_degc) < 1.0;
}

std::span<const TemperatureFormat> temperature_formats() noexcept { return kFormats; }

std::vector<TemperatureCandidate> temperature_candidates(std::span<const std::int32_t> counts,
                                                         std::optional<DegC> oven) {
    const auto [least, most] = std::ranges::minmax(counts);
    const double mean =
        std::accumulate(counts.begin(), counts.end(), 0.0) / static_cast<double>(counts.size());
    const bool is_empty = least == most && (least == 0 || least == -1);
    const double largest =
        std::max(std::abs(static_cast<double>(least)), std::abs(static_cast<double>(most)));
    std::vector<TemperatureCandidate> candidates;
    for (const TemperatureFormat& format : kFormats) {
        const DegC degc(format.slope_degc * mean + format.offset_degc);
        const bool is_near = !oven || std::abs(degc.value() - oven->value()) <= kMostFromOven_degc;
        const bool has_steps = !is_shifted(format) || largest >= kShifted;
        candidates.push_back(
            {&format, degc, std::abs(format.slope_degc) * (static_cast<double>(most) - least),
             !is_empty && is_temperature_believable(degc) && is_near && has_steps});
    }
    return candidates;
}

const TemperatureFormat* only_possible(std::span<const TemperatureCandidate> candidates) noexcept {
    const auto possible = [](const TemperatureCandidate& one) { return one.is_possible; };
    if (std::ranges::count_if(candidates, possible) != 1) return nullptr;
    return std::ranges::find_if(candidates, possible)->format;
}

}  // namespace a351::daemon::believable
