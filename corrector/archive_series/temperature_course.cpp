#include "corrector/archive_series/temperature_course.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

namespace a351::corrector::archive_series {
namespace {

struct Sum {
    std::int64_t counts = 0;
    std::int64_t samples = 0;
};
using MinuteSums = std::map<std::chrono::sys_time<std::chrono::minutes>, Sum>;

/// Adds the samples [begin, end) of a segment; `time` is the time stamp of sample `begin`.
void add_record(MinuteSums& sums, const archive::Segment& segment, std::size_t begin,
                std::size_t end, UtcTime time) {
    for (std::size_t i = begin; i < end; ++i) {
        const UtcTime at = time + from_seconds(static_cast<double>(i - begin) / segment.rate_hz);
        Sum& sum = sums[std::chrono::floor<std::chrono::minutes>(at)];
        sum.counts += segment.counts[i];
        ++sum.samples;
    }
}

}  // namespace

std::vector<MinuteTemperature> temperature_course(const std::vector<archive::Segment>& segments,
                                                  const station::ChannelScale& scale) {
    MinuteSums sums;
    for (const archive::Segment& segment : segments) {
        for (std::size_t k = 0; k < segment.anchors.size(); ++k) {
            const bool is_last = k + 1 == segment.anchors.size();
            add_record(sums, segment, segment.anchors[k].offset,
                       is_last ? segment.counts.size() : segment.anchors[k + 1].offset,
                       segment.anchors[k].time);
        }
    }
    std::vector<MinuteTemperature> course;
    for (const auto& [minute, sum] : sums) {
        const double mean = static_cast<double>(sum.counts) / static_cast<double>(sum.samples);
        course.push_back(
            {minute + std::chrono::seconds(30), DegC(scale.offset + scale.gain * mean)});
    }
    return course;
}

bool is_without_gaps(const std::vector<MinuteTemperature>& course, UtcTime from, UtcTime to) {
    UtcTime last = from;
    bool is_any = false;
    for (const MinuteTemperature& minute : course) {
        if (minute.middle < from || minute.middle > to) continue;
        if (minute.middle - last > kLongestOuterGap) return false;
        last = minute.middle;
        is_any = true;
    }
    return is_any && to - last <= kLongestOuterGap;
}

std::vector<double> interpolated(const std::vector<MinuteTemperature>& course,
                                 const std::vector<UtcTime>& times, Nanoseconds gap) {
    std::vector<double> values;
    auto after = course.begin();  // the first mean after the instant
    for (const UtcTime time : times) {
        while (after != course.end() && after->middle <= time) ++after;
        const MinuteTemperature& last = after == course.begin() ? *after : *(after - 1);
        const MinuteTemperature& next = after == course.end() ? last : *after;
        const Nanoseconds apart = &last == &next ? Nanoseconds(std::chrono::abs(time - last.middle))
                                                 : next.middle - last.middle;
        if (apart > gap) {
            values.push_back(std::numeric_limits<double>::quiet_NaN());
            continue;
        }
        const double share = &last == &next ? 0.0
                                            : seconds_between(last.middle, time) /
                                                  seconds_between(last.middle, next.middle);
        values.push_back(std::lerp(last.mean.value(), next.mean.value(), share));
    }
    return values;
}

}  // namespace a351::corrector::archive_series
