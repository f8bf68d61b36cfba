#pragma once
/// @file
/// The first page of a report: what to do next.

#include <optional>
#include <string>
#include <vector>

#include "corrector/model/survey_correction.hpp"
#include "corrector/report/reading_grade.hpp"

namespace a351::corrector {

/// Returns the actions for the readings, the most urgent first; readings to trust are last.
[[nodiscard]] std::vector<std::string> actions(const SurveyCorrection& result,
                                               const std::vector<ReadingGrade>& grades);

/// Returns the limits of the survey as a whole: too few readings of the base, stations that nothing
/// checks.
[[nodiscard]] std::vector<std::string> limits_of(const SurveyCorrection& result);

/// Returns the standard error of an RMS, RMS / sqrt(2 dof), in mGal; std::nullopt without a degree
/// of freedom.
[[nodiscard]] std::optional<double> standard_error_of_rms(const ModelScore& score);

/// Returns a sentence on the uncertainty of the scatter.
[[nodiscard]] std::string scatter_sentence(const ModelScore& score);

/// Returns the HTML of the page.
/// @param missing  lines on missing figures.
[[nodiscard]] std::string summary_html(const SurveyCorrection& result,
                                       const std::vector<std::string>& warnings,
                                       const std::vector<std::string>& missing);

}  // namespace a351::corrector
