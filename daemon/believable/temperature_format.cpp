#include "daemon/believable/temperature_format.hpp"

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
    // M-A352AD10 data sheet, rev. 20251023, 7.6.
    TemperatureFormat{"slope and offset", kSlope_degc, kOffset_degc},
    // M-G362 data sheet, 2013: a 32-bit value is the 16-bit value x 65536.
    TemperatureFormat{"slope and offset, counts x 65536", kSlope_degc / kShifted, kOffset_degc},
    // keisukesakasai/ma550ac d46f5c0, tpdo4.conf: int32 / 2^10 of an M-A550AC.
    TemperatureFormat{"1/1024 degC", 1.0 / 1024.0, 0.0},
};

bool is_shifted(const TemperatureFormat& format) {
    return format.slope_degc == kSlope_degc / kShifted;
}

}  // namespace

bool TemperatureFormat::is_that_of(const wire::DeviceProfile& profile) const noexcept {
    constexpr double kNear = 0.01;  // of the slope; 1 degC of the offset
    return std::abs(profile.temperature_slope_degc - slope_degc) < kNear * std::abs(slope_degc) &&
           std::abs(profile.temperature_offset_degc - offset_degc) < 1.0;
}

std::span<const TemperatureFormat> temperature_formats() noexcept { return kFormats; }

std::vector<TemperatureCandidate> temperature_candidates(std::span<const std::int32_t> counts) {
    const auto [least, most] = std::ranges::minmax(counts);
    const double mean =
        std::accumulate(counts.begin(), counts.end(), 0.0) / static_cast<double>(counts.size());
    const bool is_empty = least == most && (least == 0 || least == -1);
    const double largest =
        std::max(std::abs(static_cast<double>(least)), std::abs(static_cast<double>(most)));
    std::vector<TemperatureCandidate> candidates;
    for (const TemperatureFormat& format : kFormats) {
        const DegC degc(format.slope_degc * mean + format.offset_degc);
        const bool has_steps = !is_shifted(format) || largest >= kShifted;
        candidates.push_back(
            {&format, degc, !is_empty && is_temperature_believable(degc) && has_steps});
    }
    return candidates;
}

}  // namespace a351::daemon::believable
