#include "corrector/reading/vertical_axis.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::reading {
namespace {

constexpr double kSteepDip_deg = 45.0;
constexpr double kMps2PerG = kMilliGalPerStandardGravity * 1e-5;

/// Returns the mean of an axis over one sample per second in the windows, g; absent without one.
std::optional<double> mean_g(const std::vector<archive::Segment>& segments,
                             const station::ChannelScale& scale,
                             const std::vector<OccupationWindow>& windows) {
    double sum = 0.0, count = 0.0;
    for (const archive::Segment& segment : segments) {
        const auto step = static_cast<std::size_t>(std::max(1.0, segment.rate_hz));
        for (std::size_t i = 0; i < segment.counts.size(); i += step) {
            const UtcTime time = segment.time_of(i);
            if (std::ranges::none_of(windows, [time](const OccupationWindow& window) {
                    return window.start <= time && time < window.end;
                }))
                continue;
            sum += scale.offset + scale.gain * static_cast<double>(segment.counts[i]);
            count += 1.0;
        }
    }
    if (count == 0.0) return std::nullopt;
    return sum / count / kMps2PerG;
}

/// Returns the axis that the metadata call vertical, or the end.
auto named_vertical(const SurveyChannels& channels) {
    return std::ranges::find_if(channels.axes, [](const station::ChannelScale& axis) {
        return axis.dip_deg && std::abs(*axis.dip_deg) > kSteepDip_deg;
    });
}

void put_last(SurveySamples& samples, SurveyChannels& channels, std::ptrdiff_t at) {
    std::rotate(samples.axes.begin() + at, samples.axes.begin() + at + 1, samples.axes.end());
    std::rotate(channels.axes.begin() + at, channels.axes.begin() + at + 1, channels.axes.end());
}

std::string in_g(double value) { return text::fixed(value, 4) + " g"; }

}  // namespace

VerticalAxis put_vertical_last(SurveySamples& samples, SurveyChannels& channels,
                               const std::vector<OccupationWindow>& windows,
                               const std::filesystem::path& file) {
    std::array<double, 3> means{};
    std::string list;
    bool is_complete = true;
    for (std::size_t k = 0; k < means.size(); ++k) {
        const auto mean = mean_g(samples.axes[k].segments, channels.axes[k], windows);
        means[k] = mean.value_or(0.0);
        is_complete = is_complete && mean.has_value();
        list += fmt::format("{}{} {}", k == 0 ? "" : ", ", channels.axes[k].code, in_g(means[k]));
    }
    const auto distance = [](double mean) { return std::abs(std::abs(mean) - 1.0); };
    const auto nearest =
        static_cast<std::size_t>(std::ranges::min_element(means, {}, distance) - means.begin());
    if (!is_complete) return {channels.axes.back().code, StandardGravity(0.0), {}};
    if (std::abs(means[nearest]) < kLeastVertical.value())
        throw InputError(fmt::format(
            "{}: no axis is vertical: {}; allowed: an axis with at least {} along gravity",
            file.string(), list, in_g(kLeastVertical.value())));
    VerticalAxis vertical{channels.axes[nearest].code, StandardGravity(means[nearest]), {}};
    const auto named = named_vertical(channels);
    if (named != channels.axes.end() && named->code != vertical.code)
        vertical.warning = text::message(
            "{}: {} is vertical by its dip, but gravity is along {} ({}); {} is used; the axis "
            "biases of a calibration belong to the usual mounting",
            file.string(), named->code, vertical.code, list, vertical.code);
    if (means[nearest] < 0.0)
        vertical.warning += text::message("{}the sensor is mounted upside down: {} has {}",
                                          vertical.warning.empty() ? file.string() + ": " : "; ",
                                          vertical.code, in_g(means[nearest]));
    put_last(samples, channels, static_cast<std::ptrdiff_t>(nearest));
    return vertical;
}

VerticalAxis put_named_vertical_last(SurveySamples& samples, SurveyChannels& channels) {
    const auto named = named_vertical(channels);
    if (named != channels.axes.end()) put_last(samples, channels, named - channels.axes.begin());
    return {channels.axes.back().code, StandardGravity(0.0), {}};
}

}  // namespace a351::corrector::reading
