#pragma once

#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "corrector/reading/finding.hpp"
#include "corrector/reading/survey_row.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::mistake {

/// Returns what is worth a look in a corrected survey and no mistake: temperature_moving,
/// base_not_revisited and not_visited, in this order.
///
/// - temperature_moving: model::temperature_doubt() of a reading, if the model has no rate, the
///   reading is outside the fit, or its u is more than 1.5 times the middle one of the day.
/// - base_not_revisited: the base has one stay, of five or more.
/// @param rows  all readings of the survey, also those that could not be corrected.
[[nodiscard]] std::vector<reading::Finding> survey_remarks(
    const model::SurveyCorrection& result, const std::vector<reading::SurveyRow>& rows,
    const std::vector<text::Site>& sites);

}  // namespace a351::corrector::mistake
