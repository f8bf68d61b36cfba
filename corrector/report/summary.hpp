#pragma once
/// @file
/// The page of a report that a person acts on.

#include <optional>
#include <string>
#include <vector>

#include "corrector/model/survey_correction.hpp"
#include "corrector/report/reading_grade.hpp"

namespace a351::corrector {

/// What to do about the readings, most urgent first; readings to trust come last.
[[nodiscard]] std::vector<std::string> actions(const SurveyCorrection& result,
                                               const std::vector<ReadingGrade>& grades);

/// What the survey as a whole cannot tell: too few readings of the base, stations that nothing
/// checks.
[[nodiscard]] std::vector<std::string> limits_of(const SurveyCorrection& result);

/// Standard error of an RMS, RMS / sqrt(2 dof).
/// @return std::nullopt without a degree of freedom.
[[nodiscard]] std::optional<double> standard_error_of_rms(const ModelScore& score);

/// What the scatter found is worth, as a sentence.
[[nodiscard]] std::string honest_sentence(const ModelScore& score);

/// HTML of the page.
/// @param missing  lines on figures that are missing.
[[nodiscard]] std::string summary_html(const SurveyCorrection& result,
                                       const std::vector<std::string>& warnings,
                                       const std::vector<std::string>& missing);

}  // namespace a351::corrector
