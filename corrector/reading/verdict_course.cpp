#include "corrector/reading/verdict_course.hpp"

#include <algorithm>
#include <chrono>

namespace a351::corrector::reading {

std::vector<VerdictSpan> verdict_course(
    std::vector<events::Event> events,
    const std::vector<archive_series::MinuteTemperature>& course) {
    std::erase_if(events, [](const events::Event& event) {
        return event.type != "verdict" || !event.details.contains("state");
    });
    std::ranges::stable_sort(events, {}, &events::Event::utc);
    constexpr std::chrono::seconds kHalfMinute(30);
    std::vector<VerdictSpan> spans;
    for (std::size_t i = 0; i < course.size();) {
        const UtcTime begin = course[i].middle - kHalfMinute;
        UtcTime end = begin;
        while (i < course.size() && course[i].middle - kHalfMinute == end)
            end = course[i++].middle + kHalfMinute;
        for (std::size_t k = 0; k < events.size(); ++k) {
            const UtcTime from = std::max(begin, events[k].utc);
            const UtcTime to = k + 1 < events.size() ? std::min(end, events[k + 1].utc) : end;
            if (from < to) spans.push_back({from, to, events[k].details.at("state")});
        }
    }
    return spans;
}

}  // namespace a351::corrector::reading
