#include "corrector/reading/vertical_axis.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "protocol/core/input_error.hpp"
#include "protocol/core/sensor_limits.hpp"
#include "protocol/events/face.hpp"
#include "protocol/signal/median.hpp"
#include "protocol/station/station_xml.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::reading {
namespace {

using archive_series::kVertical;
constexpr double kSteepDip_deg = 45.0;
constexpr double kMps2PerG = kMilliGalPerStandardGravity * 1e-5;

/// Returns the means of an axis over one sample per second of each window, g; NaN without samples.
std::vector<double> means_g(const std::vector<archive::Segment>& segments,
                            const station::ChannelScale& scale,
                            const std::vector<OccupationWindow>& windows) {
    std::vector<double> sums(windows.size()), counts(windows.size());
    for (const archive::Segment& segment : segments) {
        const auto step = static_cast<std::size_t>(std::max(1.0, segment.rate_hz));
        for (std::size_t i = 0; i < segment.counts.size(); i += step) {
            const UtcTime time = segment.time_of(i);
            const auto window = std::ranges::find_if(windows, [time](const OccupationWindow& one) {
                return one.start <= time && time < one.end;
            });
            if (window == windows.end()) continue;
            const auto k = static_cast<std::size_t>(window - windows.begin());
            sums[k] += scale.offset + scale.gain * static_cast<double>(segment.counts[i]);
            counts[k] += 1.0;
        }
    }
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] /= counts[k] * kMps2PerG;
    return sums;
}

/// Returns the median size of the means.
double size_g(std::vector<double> means) {
    for (double& mean : means) mean = std::abs(mean);
    return signal::median(std::move(means));
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
    std::array<std::vector<double>, kVertical + 1> all_g, used_g;
    for (std::size_t k = 0; k < all_g.size(); ++k)
        all_g[k] = means_g(samples[k].segments, axes[k], windows);
    // Values of a wrong profile say nothing about the mounting; their windows are left out later.
    for (std::size_t i = 0; i < windows.size(); ++i)
        if (is_norm_believable(StandardGravity(std::hypot(all_g[0][i], all_g[1][i], all_g[2][i]))))
            for (std::size_t k = 0; k < all_g.size(); ++k) used_g[k].push_back(all_g[k][i]);
    if (used_g[0].empty()) return {};
    std::array<double, kVertical + 1> sizes{};
    std::array<bool, kVertical + 1> is_upside_down{};  ///< In all windows.
    std::string list;
    for (std::size_t k = 0; k < sizes.size(); ++k) {
        const std::vector<double>& means = used_g[k];
        sizes[k] = size_g(means);
        is_upside_down[k] = std::ranges::max(means) < 0.0;
        list += fmt::format("{}{} {}", k == 0 ? "" : ", ", axes[k].code,
                            in_g(is_upside_down[k] ? -sizes[k] : sizes[k]));
    }
    const std::size_t nearest = events::vertical_axis(sizes);
    if (!events::face_of(StandardGravity(sizes[nearest])))
        throw InputError(fmt::format(
            "{}: no axis is vertical: {}; allowed: an axis with at least {} along gravity",
            file.string(), list, in_g(events::kLeastVertical.value())));
    const std::string code = axes[nearest].code;
    text::Message warning;
    if (const auto named = named_vertical(epoch); named && *named != nearest)
        warning = text::message(
            "{}: {} is vertical by its dip, but gravity is along {} ({}); {} is used; the axis "
            "biases of a calibration belong to the usual mounting",
            file.string(), axes[*named].code, code, list, code);
    if (is_upside_down[nearest])
        warning += text::message("{}the sensor is mounted upside down: {} has {}",
                                 warning.empty() ? file.string() + ": " : "; ", code,
                                 in_g(-sizes[nearest]));
    put_last(samples, epoch, nearest);
    return warning;
}

void put_named_vertical_last(std::vector<archive::ChannelData>& samples,
                             archive_series::Epoch& epoch) {
    if (const auto named = named_vertical(epoch)) put_last(samples, epoch, *named);
}

}  // namespace a351::corrector::reading
