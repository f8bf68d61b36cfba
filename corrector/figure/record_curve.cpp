#include "corrector/figure/record_curve.hpp"

#include <algorithm>

#include "protocol/core/units.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {

std::string curve_lines(const Curve& curve) {
    const std::size_t count = curve.values.size(), each = (count + kMostSteps - 1) / kMostSteps;
    std::string lines;
    for (std::size_t first = 0; first < count; first += each) {
        const auto step = curve.values.subspan(first, std::min(each, count - first));
        const auto [low, high] = std::ranges::minmax(step);
        const double hours =
            curve.first_h + curve.step_h * 0.5 * static_cast<double>(2 * first + step.size() - 1);
        lines += data_line("55", {hours, curve.factor * (low - curve.offset)});
        if (each > 1) lines += data_line("55", {hours, curve.factor * (high - curve.offset)});
    }
    return lines;
}

std::string hours_after(UtcTime start) { return text::tr("Hours after {}", to_rfc3339(start)); }

double step_h_of(const long_record::RecordResult& result) {
    return result.record.step_s / kSecondsPerHour;
}

std::string published_value(const long_record::RecordResult& result, std::string_view key) {
    const auto statistics = long_record::record_statistics(result);
    return std::ranges::find(statistics, key, &long_record::RecordStatistic::key)->published;
}

}  // namespace a351::corrector::figure
