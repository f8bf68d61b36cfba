#pragma once

#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "corrector/reading/finding.hpp"
#include "corrector/reading/survey_row.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::judgement {

/// Returns what is worth a look in a corrected survey and no mistake: base_not_revisited, doubtful_site and not_visited, in
/// this order.
///
/// - base_not_revisited: the base has one stay, of five or more.
/// - doubtful_site: text::doubtful_site().
/// - not_visited: not in a survey with the finding other_unit, which is a part of the day.
/// @param rows  all readings of the survey, also those that could not be corrected.
[[nodiscard]] std::vector<reading::Finding> survey_remarks(
    const model::SurveyCorrection& result, const std::vector<reading::SurveyRow>& rows,
    const std::vector<text::Site>& sites);

}  // namespace a351::corrector::judgement
