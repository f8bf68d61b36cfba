#include "corrector/reading/start_up_findings.hpp"

#include <algorithm>

namespace a351::corrector::reading {

std::vector<Finding> start_up_findings(std::vector<events::Event> events,
                                       const std::string& serial_number, UtcTime from, UtcTime to) {
    std::erase_if(events, [&](const events::Event& event) {
        const std::string tested = event.detail("serial_number");
        const bool is_other = !serial_number.empty() && !tested.empty() && tested != serial_number;
        return event.type != "start_up_test" || !event.details.contains("result") || is_other;
    });
    std::ranges::stable_sort(events, {}, &events::Event::utc);
    std::vector<Finding> findings;
    for (std::size_t k = 0; k < events.size(); ++k) {
        const std::string& result = events[k].details.at("result");
        const bool ends_before = k + 1 < events.size() && events[k + 1].utc <= from;
        if (result == "passed" || events[k].utc >= to || ends_before) continue;
        Finding& finding = findings.emplace_back(
            Finding{.kind = FindingKind::start_up_test, .time = events[k].utc});
        const std::string at = to_rfc3339(events[k].utc);
        const std::string tested = events[k].detail("serial_number");
        const std::string unit = tested.empty() ? "?" : tested;
        if (result == "unknown") {
            finding.code = "start_up_test_unknown";
            finding.text = text::message(
                "it is not known whether sensor {} passed its start-up test at {}: the answer was "
                "lost",
                unit, at);
        } else {
            finding.code = "start_up_test_failed";
            finding.text = text::message(
                "sensor {} failed its start-up test at {} ({}): do not trust the readings after it",
                unit, at, result);
        }
    }
    return findings;
}

}  // namespace a351::corrector::reading
