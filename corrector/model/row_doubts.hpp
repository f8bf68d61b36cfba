#pragma once
/// @file
/// Doubts about the rows of a corrected survey.

#include <string>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// Sets doubt_physical and doubt_statistical of every row.
///
/// The statistical test compares the external studentised residual of the least-squares fit of the
/// model's terms, or of the network, with studentised_limit(), row by row.  For the whole-day model
/// it compares the studentised residual of the prediction without the row's station with this
/// limit.  `paper` has no statistical test.
/// @param result  from correct_survey(); changed in place.
void set_doubts(SurveyCorrection& result);

/// Returns the doubtful rows with their reasons, one per line, or a line that there are none.
[[nodiscard]] std::string doubts_text(const SurveyCorrection& result);

}  // namespace a351::corrector
