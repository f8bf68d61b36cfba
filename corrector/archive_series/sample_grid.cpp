#include "corrector/archive_series/sample_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace a351::corrector::archive_series {
namespace {

/// Shortest time from which a rate is computed, s.  Reason: over less than a minute the rounding of
/// the time stamps causes a larger error than the rate of the header has.
constexpr double kShortestForRate_s = 60.0;

/// Returns the offset of the first sample at or after `time`; the size if there is none.
std::size_t first_at_or_after(const archive::Segment& segment, UtcTime time) {
    std::size_t first = 0, end = segment.counts.size();
    while (first < end) {
        const std::size_t middle = first + (end - first) / 2;
        if (segment.time_of(middle) < time)
            first = middle + 1;
        else
            end = middle;
    }
    return first;
}

/// Returns the rate between the first and the last time stamp of samples [first, end).
double observed_rate_hz(const archive::Segment& segment, std::size_t first, std::size_t end) {
    const auto anchor_from = [&](std::size_t sample) {
        return std::ranges::lower_bound(segment.anchors, sample, {},
                                        &archive::Segment::Anchor::offset);
    };
    const auto earliest = anchor_from(first), next = anchor_from(end);
    if (earliest == next) return segment.rate_hz;
    const archive::Segment::Anchor& latest = *std::prev(next);
    const double seconds = seconds_between(earliest->time, latest.time);
    if (seconds < kShortestForRate_s) return segment.rate_hz;
    return static_cast<double>(latest.offset - earliest->offset) / seconds;
}

}  // namespace

void fill(std::span<double> values, std::int64_t at, const std::vector<NumberedSamples>& samples,
          double gain, double offset) {
    std::ranges::fill(values, std::numeric_limits<double>::quiet_NaN());
    const std::int64_t values_end = at + static_cast<std::int64_t>(values.size());
    for (const NumberedSamples& part : samples) {
        const std::int64_t end = std::min(part.end(), values_end);
        for (std::int64_t i = std::max(part.first, at); i < end; ++i)
            values[static_cast<std::size_t>(i - at)] =
                offset + gain * part.counts[static_cast<std::size_t>(i - part.first)];
    }
}

std::optional<SampleGrid> sampling_grid(const std::vector<archive::Segment>& segments,
                                        UtcTime start, UtcTime end) {
    std::optional<UtcTime> origin;
    double rate_hz = 0.0;
    std::size_t longest = 0;
    for (const archive::Segment& segment : segments) {
        const std::size_t first = first_at_or_after(segment, start);
        const std::size_t past = first_at_or_after(segment, end);
        if (first == past) continue;
        const UtcTime first_time = segment.time_of(first);
        if (!origin || first_time < *origin) origin = first_time;
        if (past - first <= longest) continue;
        longest = past - first;
        rate_hz = observed_rate_hz(segment, first, past);
    }
    if (!origin) return std::nullopt;
    // The last sample is before `end`, with half a sample of tolerance for rounded stamps.
    const double count = std::ceil(seconds_between(*origin, end) * rate_hz - 0.5);
    return SampleGrid{*origin, rate_hz, static_cast<std::size_t>(std::max(count, 1.0))};
}

std::vector<NumberedSamples> number_on_grid(const std::vector<archive::Segment>& segments,
                                            const SampleGrid& grid) {
    std::vector<NumberedSamples> numbered;
    const UtcTime earliest = grid.origin - from_seconds(0.5 / grid.rate_hz);
    for (const archive::Segment& segment : segments) {
        const std::size_t first = first_at_or_after(segment, earliest);
        if (first == segment.counts.size()) continue;
        const std::int64_t number =
            std::llround(seconds_between(grid.origin, segment.time_of(first)) * grid.rate_hz);
        if (number >= 0) numbered.push_back({std::span(segment.counts).subspan(first), number});
    }
    return numbered;
}

std::vector<double> place_on_grid(const std::vector<archive::Segment>& segments,
                                  const station::ChannelScale& scale, const SampleGrid& grid) {
    std::vector<double> values(grid.count);
    fill(values, 0, number_on_grid(segments, grid), scale.gain, scale.offset);
    return values;
}

}  // namespace a351::corrector::archive_series
