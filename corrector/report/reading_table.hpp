#pragma once
/// @file
/// The table of readings in a report.

#include <string>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// Returns the table of all readings with every correction, and an explanation of its columns, as
/// HTML.  The columns are those of the model.  Occupations without a value have a row too.
[[nodiscard]] std::string occupations_html(const SurveyCorrection& result);

}  // namespace a351::corrector
