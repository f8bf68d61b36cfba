#pragma once

#include "corrector/job/survey_file.hpp"
#include "corrector/model/corrected_survey.hpp"
#include "corrector/reading/occupation_rows.hpp"

namespace a351::corrector::job {

/// Corrects the readings of a survey file and searches them for mistakes.
/// @param read  from read_survey(); its warnings grow.
/// @throws InputError  as model::correct_survey(); names the survey file and every occupation left
///                     out.
[[nodiscard]] model::SurveyCorrection correct_survey_day(const SurveyFile& survey,
                                                         reading::OccupationRows& read);

}  // namespace a351::corrector::job
