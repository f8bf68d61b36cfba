#include "corrector/reading/occupation_window.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "protocol/archive/channel_code.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::reading {
namespace {

/// Samples of temperature beyond each end.  Reason: more than the reach of both decimation filters,
/// 41 + 10 x 41 samples.
constexpr std::size_t kTemperatureMargin = 500;

/// Shortest time from which a rate is computed, s.  Reason: over less than a minute the rounding of
/// the time stamps causes a larger error than the rate of the header has.
constexpr double kShortestForRate_s = 60.0;

/// Returns the offset of the first sample at or after `time`; the size if there is none.
std::size_t first_at_or_after(const archive::Segment& segment, UtcTime time) {
    std::size_t low = 0;
    std::size_t high = segment.counts.size();
    while (low < high) {
        const std::size_t middle = low + (high - low) / 2;
        if (segment.time_of(middle) < time) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

/// Returns the rate between the first and the last time stamp of samples [first, behind).
double observed_rate_hz(const archive::Segment& segment, std::size_t first, std::size_t behind) {
    const archive::Segment::Anchor* earliest = nullptr;
    const archive::Segment::Anchor* latest = nullptr;
    for (const archive::Segment::Anchor& anchor : segment.anchors) {
        if (anchor.offset < first || anchor.offset >= behind) continue;
        if (earliest == nullptr) earliest = &anchor;
        latest = &anchor;
    }
    if (earliest == nullptr) return segment.rate_hz;
    const double seconds = seconds_between(earliest->time, latest->time);
    if (seconds < kShortestForRate_s) return segment.rate_hz;
    return static_cast<double>(latest->offset - earliest->offset) / seconds;
}

TimeSeries<StandardGravity> axis_series(const std::vector<double>& values_mps2,
                                        const SampleGrid& grid) {
    constexpr double kMetresPerSecond2PerMilliGal = 1e-5;
    constexpr double kMps2PerG = kMilliGalPerStandardGravity * kMetresPerSecond2PerMilliGal;
    std::vector<double> values_g(values_mps2.size());
    std::transform(values_mps2.begin(), values_mps2.end(), values_g.begin(),
                   [](double value) { return value / kMps2PerG; });
    return {grid.origin, Hertz(grid.rate_hz), std::move(values_g)};
}

station::ChannelScale channel_with(const station::Metadata& station, const std::string& ending,
                                   const std::string& unit, const std::filesystem::path& file) {
    std::vector<std::string> codes;
    for (const station::ChannelScale& channel : station.channels) {
        codes.push_back(channel.code);
        if (channel.code.size() != 3 || channel.code.substr(1) != ending) continue;
        if (channel.code.front() == 'L') continue;  // derived, 1 Hz
        if (channel.unit == unit) return channel;
        throw InputError(fmt::format("{}: channel {}: unit = {}; allowed: {}", file.string(),
                                     channel.code, channel.unit, unit));
    }
    throw InputError(fmt::format("{}: no channel ?{}; there are: {}", file.string(), ending,
                                 text::joined(codes)));
}

}  // namespace

std::optional<SampleGrid> sampling_grid(const std::vector<archive::Segment>& segments,
                                        UtcTime start, UtcTime end) {
    std::optional<UtcTime> origin;
    double rate_hz = 0.0;
    std::size_t longest = 0;
    for (const archive::Segment& segment : segments) {
        const std::size_t first = first_at_or_after(segment, start);
        const std::size_t behind = first_at_or_after(segment, end);
        if (first == behind) continue;
        const UtcTime first_time = segment.time_of(first);
        if (!origin || first_time < *origin) origin = first_time;
        if (behind - first <= longest) continue;
        longest = behind - first;
        rate_hz = observed_rate_hz(segment, first, behind);
    }
    if (!origin) return std::nullopt;
    // The last sample is before `end`, with half a sample of tolerance for rounded stamps.
    const double count = std::ceil(seconds_between(*origin, end) * rate_hz - 0.5);
    return SampleGrid{*origin, rate_hz, static_cast<std::size_t>(std::max(count, 1.0))};
}

std::vector<double> place_on_grid(const std::vector<archive::Segment>& segments,
                                  const station::ChannelScale& scale, const SampleGrid& grid) {
    std::vector<double> values(grid.count, std::numeric_limits<double>::quiet_NaN());
    const UtcTime earliest = grid.origin - from_seconds(0.5 / grid.rate_hz);
    for (const archive::Segment& segment : segments) {
        const std::size_t first = first_at_or_after(segment, earliest);
        if (first == segment.counts.size()) continue;
        const long long place =
            std::llround(seconds_between(grid.origin, segment.time_of(first)) * grid.rate_hz);
        if (place < 0) continue;
        const auto begin = static_cast<std::size_t>(place);
        for (std::size_t i = first; i < segment.counts.size(); ++i) {
            const std::size_t at = begin + (i - first);
            if (at >= values.size()) break;
            values[at] = scale.offset + scale.gain * static_cast<double>(segment.counts[i]);
        }
    }
    return values;
}

SurveyChannels find_channels(const station::Metadata& station, const std::filesystem::path& file) {
    SurveyChannels channels;
    for (std::size_t k = 0; k < channels.axes.size(); ++k)
        channels.axes[k] = channel_with(station, "N" + station.codes.axes[k], "m/s**2", file);
    channels.temperature = channel_with(station, "K1", "degC", file);
    const auto outer = std::ranges::find(station.channels, archive::kOuterTemperature,
                                         &station::ChannelScale::code);
    if (outer != station.channels.end() && outer->unit != "degC")
        throw InputError(fmt::format("{}: channel {}: unit = {}; allowed: degC", file.string(),
                                     outer->code, outer->unit));
    if (outer != station.channels.end()) channels.outer = *outer;
    return channels;
}

void add_damage(std::vector<text::Message>& warnings, const archive::ChannelData& channel) {
    for (const archive::Damage& damage : channel.damage)
        warnings.push_back(
            damage.is_of_another_station
                ? text::message("{}: offset {}: {} bytes are a record of another station",
                                damage.file.filename().string(), damage.offset, damage.byte_count)
                : text::message("{}: offset {}: {} bytes are not a record",
                                damage.file.filename().string(), damage.offset, damage.byte_count));
}

std::optional<OccupationRecord> cut_occupation(const SurveySamples& samples,
                                               const SurveyChannels& channels, UtcTime start,
                                               UtcTime end) {
    const auto grid = sampling_grid(samples.axes[2].segments, start, end);
    if (!grid) return std::nullopt;
    const auto axis = [&](std::size_t k) {
        return axis_series(place_on_grid(samples.axes[k].segments, channels.axes[k], *grid), *grid);
    };
    const Nanoseconds margin =
        from_seconds(static_cast<double>(kTemperatureMargin) / grid->rate_hz);
    const SampleGrid wider{grid->origin - margin, grid->rate_hz,
                           grid->count + 2 * kTemperatureMargin};
    return OccupationRecord{
        axis(0), axis(1), axis(2),
        TimeSeries<DegC>(wider.origin, Hertz(wider.rate_hz),
                         place_on_grid(samples.temperature.segments, channels.temperature, wider))};
}

}  // namespace a351::corrector::reading
