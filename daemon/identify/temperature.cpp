#include "daemon/identify/temperature.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "daemon/believable/temperature_format.hpp"

namespace a351::daemon::identify {
namespace {

believable::TemperatureCounts counts_of(std::span<const wire::BurstValues> frames) {
    const auto [least, most] =
        std::ranges::minmax_element(frames, {}, &wire::BurstValues::temperature);
    double sum = 0.0;
    for (const wire::BurstValues& frame : frames) sum += frame.temperature;
    return {least->temperature, most->temperature, sum / static_cast<double>(frames.size())};
}

}  // namespace

TemperatureFinding temperature_of(std::span<const wire::BurstValues> frames,
                                  const wire::DeviceProfile& profile) {
    const believable::TemperatureCounts counts = counts_of(frames);
    const believable::TemperatureFormat own = believable::format_of(profile);
    std::string text =
        fmt::format("profile {}: {:.2f} degC; for the counts N the formats of the family give",
                    profile.name, own.temperature(counts).value());
    for (const believable::TemperatureFormat& format : believable::temperature_formats()) {
        text += fmt::format("{} {:.2f} ({})", text.ends_with(')') ? "," : "",
                            format.temperature(counts).value(), format.formula);
    }
    const auto fits = believable::fitting_formats(counts, own);
    if (fits.empty()) return {Verdict::differs, text + "; none of them is possible", {}};
    const believable::TemperatureFormat& format = fits[0].format;
    const Changes::Temperature change{format.slope_degc, format.offset_degc};
    if (fits[0].is_of_profile) return {Verdict::confirmed, text, change};
    return {Verdict::differs,
            fmt::format("{}; the format that fits is {} degC", text, format.formula), change};
}

}  // namespace a351::daemon::identify
