#include "corrector/archive_series/temperature_course.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

namespace a351::corrector::archive_series {
std::vector<MinuteTemperature> temperature_course(const std::vector<archive::Segment>& segments,
                                                  const station::ChannelScale& scale) {
    struct Sum {
        std::int64_t counts = 0, samples = 0;
    };
    std::map<std::chrono::sys_time<std::chrono::minutes>, Sum> sums;
    auto minute = sums.end();  // Neighbouring samples are mostly of one minute.
    for (const archive::Segment& segment : segments) {
        for (std::size_t k = 0; k < segment.anchors.size(); ++k) {
            const archive::Segment::Anchor& anchor = segment.anchors[k];
            const std::size_t end = k + 1 < segment.anchors.size() ? segment.anchors[k + 1].offset
                                                                   : segment.counts.size();
            for (std::size_t i = anchor.offset; i < end; ++i) {
                const double after_s = static_cast<double>(i - anchor.offset) / segment.rate_hz;
                const UtcTime time = anchor.time + from_seconds(after_s);
                const auto of_sample = std::chrono::floor<std::chrono::minutes>(time);
                if (minute == sums.end() || minute->first != of_sample)
                    minute = sums.try_emplace(of_sample).first;
                minute->second.counts += segment.counts[i];
                ++minute->second.samples;
            }
        }
    }
    std::vector<MinuteTemperature> course;
    for (const auto& [begin, sum] : sums) {
        const double mean = static_cast<double>(sum.counts) / static_cast<double>(sum.samples);
        course.push_back(
            {begin + std::chrono::seconds(30), DegC(scale.offset + scale.gain * mean)});
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
    std::vector<double> values(times.size(), std::numeric_limits<double>::quiet_NaN());
    if (course.empty()) return values;
    auto after = course.begin();  // the first mean after the instant
    for (std::size_t i = 0; i < times.size(); ++i) {
        while (after != course.end() && after->middle <= times[i]) ++after;
        const bool is_outside = after == course.begin() || after == course.end();
        const MinuteTemperature& last = after == course.begin() ? *after : *(after - 1);
        if ((is_outside ? Nanoseconds(std::chrono::abs(times[i] - last.middle))
                        : after->middle - last.middle) > gap)
            continue;
        values[i] = is_outside ? last.mean.value()
                               : std::lerp(last.mean.value(), after->mean.value(),
                                           seconds_between(last.middle, times[i]) /
                                               seconds_between(last.middle, after->middle));
    }
    return values;
}

}  // namespace a351::corrector::archive_series
