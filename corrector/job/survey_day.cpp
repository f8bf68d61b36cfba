#include "corrector/job/survey_day.hpp"

#include <fmt/core.h>

#include "corrector/job/survey_readings.hpp"
#include "corrector/mistake/survey_findings.hpp"
#include "corrector/model/calibration_use.hpp"
#include "corrector/model/survey_correction.hpp"
#include "protocol/core/input_error.hpp"

namespace a351::corrector::job {

model::SurveyCorrection correct_survey_day(const SurveyFile& survey,
                                           reading::OccupationRows& read) {
    const reading::DayRecord* const day = read.day ? &*read.day : nullptr;
    try {
        model::SurveyCorrection result =
            model::correct_with_calibration(read.rows, with_sites_of(read, survey.survey), day);
        model::add_left_out(result, read.left_out);
        result.findings = read.findings;
        result.findings = mistake::find_mistakes(result, {read.rows, read.sites, day});
        return result;
    } catch (const InputError& error) {
        std::string message = fmt::format("{}: {}", survey.path.string(), error.what());
        for (const std::string& warning : read.warnings) message += "; " + warning;
        throw InputError(message);
    }
}

}  // namespace a351::corrector::job
