#include "corrector/job/survey_day.hpp"

#include <fmt/core.h>

#include "corrector/job/reference_survey.hpp"
#include "corrector/job/survey_readings.hpp"
#include "corrector/judgement/survey_findings.hpp"
#include "corrector/model/survey_correction.hpp"
#include "corrector/reading/refused.hpp"

namespace a351::corrector::job {
namespace {

std::string in_context(const InputError& error, const SurveyFile& survey,
                       const reading::OccupationRows& read) {
    std::string message = fmt::format(
        "{}: {}", (survey.path.empty() ? survey.root : survey.path).string(), error.what());
    for (const text::Message& warning : read.warnings) message += "; " + warning.english();
    return message;
}

}  // namespace

model::SurveyCorrection correct_survey_day(const SurveyFile& survey,
                                           reading::OccupationRows& read) {
    const reading::DayRecord* const day = read.day ? &*read.day : nullptr;
    try {
        std::optional<ReferenceNetwork> reference;
        if (survey.reference) reference = hold_reference_values(survey, read);
        model::SurveyCorrection result = judgement::correct_and_search(
            {read.rows, read.sites, day}, with_sites_of(read, survey.survey), read.findings);
        model::add_left_out(result, read.left_out);
        if (reference) compare_with_reference(result, *reference);
        return result;
    } catch (const reading::Refused& refused) {
        throw reading::Refused(refused.code(), in_context(refused, survey, read));
    } catch (const InputError& error) {
        throw InputError(in_context(error, survey, read));
    }
}

}  // namespace a351::corrector::job
