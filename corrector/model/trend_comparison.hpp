#pragma once

#include <string>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// One line on how far the two trends of the occupations' records (occupations.csv,
/// smoother_minus_eemd_mgal) lie apart; empty without such rows.
[[nodiscard]] std::string trend_comparison_text(const SurveyCorrection& result);

}  // namespace a351::corrector
