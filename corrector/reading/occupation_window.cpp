#include "corrector/reading/occupation_window.hpp"

#include "corrector/archive_series/sample_grid.hpp"

namespace a351::corrector::reading {
namespace {

using archive_series::SampleGrid;

/// Samples of temperature beyond each end.  Reason: more than the reach of both decimation filters,
/// 41 + 10 x 41 samples.
constexpr std::size_t kTemperatureMargin = 500;

}  // namespace

std::optional<OccupationRecord> cut_occupation(const std::vector<archive::ChannelData>& samples,
                                               const archive_series::Epoch& epoch, UtcTime start,
                                               UtcTime end) {
    using archive_series::kTemperature, archive_series::kVertical;
    const auto grid = archive_series::sampling_grid(samples[kVertical].segments, start, end);
    if (!grid) return std::nullopt;
    const auto channel = [&](std::size_t k, const SampleGrid& on) {
        return archive_series::place_on_grid(samples[k].segments, epoch.channels[k], on);
    };
    const auto axis = [&](std::size_t k) {
        constexpr double kMetresPerSecond2PerMilliGal = 1e-5;
        constexpr double kMps2PerG = kMilliGalPerStandardGravity * kMetresPerSecond2PerMilliGal;
        std::vector<double> values = channel(k, *grid);
        for (double& value : values) value /= kMps2PerG;
        return TimeSeries<StandardGravity>(grid->origin, Hertz(grid->rate_hz), std::move(values));
    };
    const Nanoseconds margin =
        from_seconds(static_cast<double>(kTemperatureMargin) / grid->rate_hz);
    const SampleGrid wider{grid->origin - margin, grid->rate_hz,
                           grid->count + 2 * kTemperatureMargin};
    return OccupationRecord{
        axis(0), axis(1), axis(kVertical),
        TimeSeries<DegC>(wider.origin, Hertz(wider.rate_hz), channel(kTemperature, wider))};
}

}  // namespace a351::corrector::reading
