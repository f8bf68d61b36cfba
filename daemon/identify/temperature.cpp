#include "daemon/identify/temperature.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace a351::daemon::identify {
namespace {

/// A format in which devices of the family send the temperature: degC = slope x counts + offset.
struct Format {
    const char* name;
    double slope_degc, offset_degc;
};
constexpr double k16Bits = 65536.0;
constexpr double kSlope_degc = -0.0037918, kOffset_degc = 34.987;  // M-A352AD10 data sheet, 7.6
constexpr std::array kFormats{
    Format{"as the A352AD10", kSlope_degc, kOffset_degc},
    // 32-bit words of the M-G362, data sheet 2013: the value of 16 bits x 65536.
    Format{"as the A352AD10 x 65536", kSlope_degc / k16Bits, kOffset_degc},
    // The M-A550AC on CAN: counts / 2^10.
    Format{"counts / 1024", 1.0 / 1024.0, 0.0},
};

constexpr std::int32_t kNoSample = -1;  // of a device without a sample, burst_frame.hpp
// Temperature that a room, a box and an oven are around, and the largest distance from it.
constexpr double kUsual_degc = 30.0, kFarthest_degc = 70.0;
// A format whose counts are finer than this has 16 bits more than the resolution of a sensor, so its
// counts are not near 0 by chance.
constexpr double kFine_degc = 1e-5;

double temperature_degc(const Format& format, double mean_counts) {
    return format.slope_degc * mean_counts + format.offset_degc;
}

/// Returns the distance from the usual temperature; infinite for a format that does not fit.
double distance_degc(const Format& format, double mean_counts) {
    const double distance = std::abs(temperature_degc(format, mean_counts) - kUsual_degc);
    const bool is_other =
        std::abs(format.slope_degc) < kFine_degc && std::abs(mean_counts) < k16Bits;
    return is_other || distance > kFarthest_degc ? std::numeric_limits<double>::infinity()
                                                 : distance;
}

}  // namespace

TemperatureFinding temperature_of(std::span<const wire::BurstValues> frames,
                                  const wire::DeviceProfile& profile) {
    double counts = 0.0;
    for (const auto& frame : frames)
        counts += frame.temperature / static_cast<double>(frames.size());
    const Format own{"", profile.temperature_slope_degc, profile.temperature_offset_degc};
    std::string text =
        fmt::format("{:.2f} degC by profile {}", temperature_degc(own, counts), profile.name);
    for (const Format& format : kFormats)
        text += fmt::format("; {:.2f} {}", temperature_degc(format, counts), format.name);
    // A quiet oven moves by one count of 16 bits in two minutes, so another constant is no fault.
    const std::int32_t first = frames.front().temperature;
    const bool is_constant =
        std::ranges::all_of(frames, [&](const auto& frame) { return frame.temperature == first; });
    if (is_constant && (first == 0 || first == kNoSample))
        return {Verdict::differs, fmt::format("{}; all counts are {}: dead", text, first), {}};
    const auto nearest = std::ranges::min_element(
        kFormats, {}, [&](const Format& format) { return distance_degc(format, counts); });
    const double best_degc = distance_degc(*nearest, counts);
    if (distance_degc(own, counts) <= best_degc && std::isfinite(distance_degc(own, counts)))
        return {Verdict::confirmed, text, Changes::Temperature{own.slope_degc, own.offset_degc}};
    if (!std::isfinite(best_degc))
        return {Verdict::differs, text + "; no format of the family fits", {}};
    return {Verdict::differs,
            fmt::format("{}; the format that fits is \"{}\"", text, nearest->name),
            Changes::Temperature{nearest->slope_degc, nearest->offset_degc}};
}

}  // namespace a351::daemon::identify
