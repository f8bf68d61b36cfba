#pragma once

#include <string>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// The table of all readings with every correction, and what its columns are, as HTML.  Columns are
/// those the model has; occupations without a value stand in their place.
[[nodiscard]] std::string occupations_html(const SurveyCorrection& result);

}  // namespace a351::corrector
