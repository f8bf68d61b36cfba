#pragma once
/// @file
/// The first sections of a report: what to do next, and how accurate the survey is.
///
/// It is for the operator who is still in the field, and for a reader who wants one number for the
/// accuracy.  Every root mean square is marked as in sample or cross-validated (summary_test.cpp).

#include <optional>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "corrector/judgement/reading_grade.hpp"
#include "corrector/model/corrected_survey.hpp"

namespace a351::corrector::report {

/// Returns the actions for the readings, the most urgent first; readings to trust are last.
///
/// Order: occupations without a value, by reason; readings to repeat at stations without a reading
/// to trust; other readings to repeat; those to use with care; those to trust.  An action without
/// readings is left out.  If nothing is to be repeated and no finding is a headline, the first
/// sentence says so.
/// @param grades  from grade_readings() of this result.
/// @return sentences in plain text; they name each reading once.
[[nodiscard]] std::vector<std::string> actions(const model::SurveyCorrection& result,
                                               const std::vector<judgement::ReadingGrade>& grades);

/// Returns the limits of the survey as a whole: too few readings of the base, stations that nothing
/// checks.
///
/// The base needs three readings in the fit, because two cannot separate drift from a bad reading.
/// Stations with one reading and no reference are listed by name.
/// @return sentences in plain text; empty if there is no limit.
[[nodiscard]] std::vector<std::string> limits_of(const model::SurveyCorrection& result);

/// Returns the standard error of an RMS, RMS / sqrt(2 dof), in mGal; std::nullopt without a degree
/// of freedom or without an RMS.
///
/// dof includes priors and datum; for a network it is that of the adjustment.  A smaller difference
/// between the RMS of two models is not significant.
[[nodiscard]] std::optional<double> standard_error_of_rms(const model::Score& score);

/// Returns a sentence on the uncertainty of the scatter, and the error to quote for a new station:
/// the leave-one-station-out error, if the model has one.
[[nodiscard]] std::string scatter_sentence(const model::Score& score);

/// Adds what the survey is, missing figures, and the number of warnings about the input.
/// @param result    at least one row.
/// @param warnings  only their number is shown, with a hint to the last section.
/// @param missing   lines on missing figures.
void add_head(pugi::xml_node parent, const model::SurveyCorrection& result,
              const std::vector<std::string>& warnings, const std::vector<std::string>& missing);

/// Adds what is wrong with the day, headlines in bold, with the amendments to paste.
void add_findings(pugi::xml_node parent, const std::vector<reading::Finding>& findings);

/// Adds the actions, and the readings that have a reason.
///
/// The readings are graded here.  A reading without a reason is not in the table.  The error is that
/// of judgement::error_of().
void add_actions(pugi::xml_node parent, const model::SurveyCorrection& result);

/// Adds the errors of the applied model, the sentence on them and the limits of the survey.
void add_accuracy(pugi::xml_node parent, const model::SurveyCorrection& result);

}  // namespace a351::corrector::report
