#include "corrector/reading/vertical_axis.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "protocol/core/input_error.hpp"
#include "protocol/station/station_xml.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::reading {
namespace {

using archive_series::kVertical;
constexpr double kSteepDip_deg = 45.0;
constexpr double kMps2PerG = kMilliGalPerStandardGravity * 1e-5;

/// Means of an axis, g.
struct AxisMean {
    double value, size;  ///< With its sign, and without: the faces of the sensor may differ.
};

/// Returns the means of an axis over one sample per second in the windows; absent without one.
std::optional<AxisMean> mean_g(const std::vector<archive::Segment>& segments,
                               const station::ChannelScale& scale,
                               const std::vector<OccupationWindow>& windows) {
    double sum = 0.0, size = 0.0, count = 0.0;
    for (const archive::Segment& segment : segments) {
        const auto step = static_cast<std::size_t>(std::max(1.0, segment.rate_hz));
        for (std::size_t i = 0; i < segment.counts.size(); i += step) {
            const UtcTime time = segment.time_of(i);
            if (std::ranges::none_of(windows, [time](const OccupationWindow& window) {
                    return window.start <= time && time < window.end;
                }))
                continue;
            const double value = scale.offset + scale.gain * static_cast<double>(segment.counts[i]);
            sum += value;
            size += std::abs(value);
            count += 1.0;
        }
    }
    if (count == 0.0) return std::nullopt;
    return AxisMean{sum / count / kMps2PerG, size / count / kMps2PerG};
}

/// Returns the place of the axis that the metadata call vertical.
std::optional<std::size_t> named_vertical(const archive_series::Epoch& epoch) {
    for (std::size_t k = 0; k <= kVertical; ++k)
        if (const auto& dip_deg = epoch.channels[k].dip_deg;
            dip_deg && std::abs(*dip_deg) > kSteepDip_deg)
            return k;
    return std::nullopt;
}

void put_last(std::vector<archive::ChannelData>& samples, archive_series::Epoch& epoch,
              std::size_t axis) {
    const auto put = [axis](auto& channels) {
        const auto first = channels.begin() + static_cast<std::ptrdiff_t>(axis);
        std::rotate(first, first + 1, channels.begin() + kVertical + 1);
    };
    put(samples);
    put(epoch.channels);
}

std::string in_g(double value) { return text::fixed(value, 4) + " g"; }

}  // namespace

text::Message put_vertical_last(std::vector<archive::ChannelData>& samples,
                                archive_series::Epoch& epoch,
                                const std::vector<OccupationWindow>& windows,
                                const std::filesystem::path& file) {
    const std::vector<station::ChannelScale>& axes = epoch.channels;
    std::array<AxisMean, kVertical + 1> means{};
    std::string list;
    bool is_complete = true;
    for (std::size_t k = 0; k < means.size(); ++k) {
        const auto mean = mean_g(samples[k].segments, axes[k], windows);
        means[k] = mean.value_or(AxisMean{});
        is_complete = is_complete && mean.has_value();
        list += fmt::format("{}{} {}", k == 0 ? "" : ", ", axes[k].code, in_g(means[k].value));
    }
    const auto distance = [](const AxisMean& mean) { return std::abs(mean.size - 1.0); };
    const auto nearest =
        static_cast<std::size_t>(std::ranges::min_element(means, {}, distance) - means.begin());
    if (!is_complete) return {};
    if (means[nearest].size < kLeastVertical.value())
        throw InputError(fmt::format(
            "{}: no axis is vertical: {}; allowed: an axis with at least {} along gravity",
            file.string(), list, in_g(kLeastVertical.value())));
    const std::string code = axes[nearest].code;
    text::Message warning;
    if (const auto named = named_vertical(epoch); named && *named != nearest)
        warning = text::message(
            "{}: {} is vertical by its dip, but gravity is along {} ({}); {} is used; the axis "
            "biases of a calibration belong to the usual mounting",
            file.string(), axes[*named].code, code, list, code);
    if (means[nearest].value < -kLeastVertical.value())
        warning += text::message("{}the sensor is mounted upside down: {} has {}",
                                 warning.empty() ? file.string() + ": " : "; ", code,
                                 in_g(means[nearest].value));
    put_last(samples, epoch, nearest);
    return warning;
}

void put_named_vertical_last(std::vector<archive::ChannelData>& samples,
                             archive_series::Epoch& epoch) {
    if (const auto named = named_vertical(epoch)) put_last(samples, epoch, *named);
}

}  // namespace a351::corrector::reading
