#include "corrector/judgement/physical_doubt.hpp"

#include <fmt/core.h>

#include <cmath>

#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::judgement {

std::string temperature_doubt(const reading::SurveyRow& row) {
    std::vector<std::string> reasons;
    if (std::abs(row.rate_degc_per_h) > kGreatestRate_degc_per_h)
        reasons.push_back(fmt::format("rate {} degC/h", text::fixed(row.rate_degc_per_h, 3)));
    if (row.record && row.record->temperature_range.value() > kGreatestRange_degc) {
        const std::string range = text::fixed(row.record->temperature_range.value(), 3);
        if (row.record->temperature_shape == reading::TemperatureShape::monotone)
            reasons.push_back(fmt::format("monotone over {} degC", range));
        else if (row.record->temperature_shape == reading::TemperatureShape::half_wave)
            reasons.push_back(fmt::format("half a wave of {} degC", range));
    }
    return text::joined(reasons, ";");
}

std::string physical_doubt(const reading::SurveyRow& row) {
    std::string reasons = temperature_doubt(row);
    for (const std::string& note : row.notes)
        if (note == "fallback" || note == "pulse") reasons += (reasons.empty() ? "" : ";") + note;
    return reasons;
}

}  // namespace a351::corrector::judgement
