#include "daemon/believable/temperature_format.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "daemon/believable/limits.hpp"

namespace a351::daemon::believable {
namespace {

constexpr double kShifted = 65536.0;

constexpr std::array kFormats{
    // M-A352AD10 data sheet, rev. 20251023, 7.6.
    TemperatureFormat{"N x -0.0037918 + 34.987", -kUsualStep_degc, 34.987},
    // M-G362 data sheet, 2013: a 32-bit value is the 16-bit value x 65536.
    TemperatureFormat{"N / 65536 x -0.0037918 + 34.987", -kUsualStep_degc / kShifted, 34.987},
    // keisukesakasai/ma550ac d46f5c0, tpdo4.conf: int32 / 2^10 of an M-A550AC.
    TemperatureFormat{"N / 1024", 1.0 / 1024.0, 0.0},
};

/// Slope below which one count is finer than the step of any thermometer, degC.
constexpr double kFine_degc = 1e-6;
/// Middle of the temperatures of rooms, boxes and ovens.
constexpr DegC kMiddle(30.0);

bool is_same(const TemperatureFormat& a, const TemperatureFormat& b) {
    constexpr double kNear = 0.01;  // of the slope; 1 degC of the offset
    return std::abs(a.slope_degc - b.slope_degc) < kNear * std::abs(b.slope_degc) &&
           std::abs(a.offset_degc - b.offset_degc) < 1.0;
}

}  // namespace

bool TemperatureFormat::is_possible(const TemperatureCounts& counts) const noexcept {
    const double largest = std::max(std::abs(double(counts.least)), std::abs(double(counts.most)));
    const bool has_steps =
        std::abs(slope_degc) > kFine_degc || largest * std::abs(slope_degc) >= kUsualStep_degc;
    return has_steps && !counts.are_empty() && is_temperature_believable(temperature(counts));
}

std::span<const TemperatureFormat> temperature_formats() noexcept { return kFormats; }

TemperatureFormat format_of(const wire::DeviceProfile& profile) noexcept {
    return {"", profile.temperature_slope_degc, profile.temperature_offset_degc};
}

std::vector<TemperatureFit> fitting_formats(const TemperatureCounts& counts,
                                            const TemperatureFormat& own,
                                            std::optional<DegC> oven) {
    std::vector<TemperatureFit> fits;
    if (own.is_possible(counts)) fits.push_back({own, own.temperature(counts), true});
    for (const TemperatureFormat& format : kFormats)
        if (!is_same(own, format) && format.is_possible(counts))
            fits.push_back({format, format.temperature(counts), false});

    const auto near_oven = std::ranges::find_if(fits, [&](const TemperatureFit& fit) {
        return oven && is_near_oven(fit.temperature, *oven);
    });
    if (near_oven != fits.end()) return {*near_oven};
    std::ranges::stable_sort(fits, {}, [](const TemperatureFit& fit) {
        const bool is_likely = fit.is_of_profile && is_temperature_usual(fit.temperature);
        return is_likely ? 0.0 : std::abs((fit.temperature - kMiddle).value());
    });
    return fits;
}

}  // namespace a351::daemon::believable
