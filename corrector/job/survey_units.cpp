#include "corrector/job/survey_units.hpp"

#include <algorithm>

#include "protocol/core/input_error.hpp"

namespace a351::corrector::job {

std::vector<SurveyFile> by_unit(const SurveyFile& survey) {
    std::vector<std::string> units;
    try {
        units = reading::units_of(survey);
    } catch (const InputError&) {
        return {survey};
    }
    if (units.size() < 2) return {survey};
    std::vector<SurveyFile> parts;
    for (const std::string& unit : units) {
        SurveyFile& part = parts.emplace_back(survey);
        part.unit = unit;
        part.name += "-" + unit;
        const auto& calibration = survey.survey.calibration;
        const bool is_of_another = calibration && calibration->serial_number != unit &&
                                   std::ranges::count(units, calibration->serial_number) > 0;
        if (!is_of_another) continue;
        part.unused_calibration = calibration->serial_number;
        part.calibration.clear();
        part.survey.calibration.reset();
    }
    return parts;
}

}  // namespace a351::corrector::job
