#pragma once
/// @file
/// Comparison of the two trends of the occupations' records.

#include <string>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// Returns one line with mean, rms and largest value of the difference between the two trends of
/// the occupations' records (occupations.csv, smoother_minus_eemd_mgal); empty without rows from
/// records.
[[nodiscard]] std::string trend_comparison_text(const SurveyCorrection& result);

}  // namespace a351::corrector
