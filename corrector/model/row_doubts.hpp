#pragma once

#include <string>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// Sets doubt_physical of every row, and doubt_statistical by least squares, or for the whole-day
/// model by what it predicts without the row's station.
void set_doubts(SurveyCorrection& result);

/// The rows in doubt with the reasons, one per line; says when there are none.
[[nodiscard]] std::string doubts_text(const SurveyCorrection& result);

}  // namespace a351::corrector
