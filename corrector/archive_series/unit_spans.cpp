#include "corrector/archive_series/unit_spans.hpp"

#include <algorithm>

#include "protocol/station/station_xml.hpp"

namespace a351::corrector::archive_series {

std::vector<UnitSpan> read_unit_spans(const std::filesystem::path& metadata) {
    std::vector<UnitSpan> spans;
    for (const auto& [start, station] : station::read_station_epochs(metadata)) {
        const bool is_first = spans.empty();
        if (!is_first && sensor_change(spans.back().serial_number, station.serial_number).empty()) {
            if (spans.back().serial_number.empty())
                spans.back().serial_number = station.serial_number;
            continue;
        }
        if (!is_first) spans.back().to = start;
        spans.push_back({is_first ? UtcTime::min() : start, UtcTime::max(), station.serial_number});
    }
    if (spans.empty()) spans.push_back({UtcTime::min(), UtcTime::max(), ""});
    return spans;
}

const UnitSpan& span_at(const std::vector<UnitSpan>& spans, UtcTime time) {
    constexpr std::chrono::seconds kClockMargin(1);
    const auto next = std::ranges::upper_bound(spans.begin() + 1, spans.end(), time + kClockMargin,
                                               {}, &UnitSpan::from);
    return *(next - 1);
}

void keep_unit(std::vector<archive::ChannelData>& samples, const std::vector<UnitSpan>& spans,
               const std::string& serial_number) {
    for (std::size_t channel = 0; channel <= kTemperature; ++channel)
        std::erase_if(samples[channel].segments, [&](const archive::Segment& segment) {
            const UtcTime middle = segment.time_of(segment.counts.size() / 2);
            return span_at(spans, middle).serial_number != serial_number;
        });
}

}  // namespace a351::corrector::archive_series
