#include "corrector/reading/signal_course.hpp"

#include <algorithm>
#include <chrono>

namespace a351::corrector::reading {

std::vector<SignalSpan> signal_course(
    std::vector<events::Event> events,
    const std::vector<archive_series::MinuteTemperature>& course) {
    std::erase_if(events, [](const events::Event& event) {
        return event.type != "signal" || !event.details.contains("word");
    });
    std::ranges::stable_sort(events, {}, &events::Event::utc);
    constexpr std::chrono::seconds kHalfMinute(30);
    std::vector<SignalSpan> spans;
    for (std::size_t i = 0; i < course.size();) {
        const UtcTime begin = course[i].middle - kHalfMinute;
        UtcTime end = begin;
        while (i < course.size() && course[i].middle - kHalfMinute == end)
            end = course[i++].middle + kHalfMinute;
        for (std::size_t k = 0; k < events.size(); ++k) {
            const UtcTime from = std::max(begin, events[k].utc);
            const UtcTime to = k + 1 < events.size() ? std::min(end, events[k + 1].utc) : end;
            if (from < to) spans.push_back({from, to, events[k].details.at("word")});
        }
    }
    return spans;
}

}  // namespace a351::corrector::reading
