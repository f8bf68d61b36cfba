#pragma once
/// @file
/// The first parts of a report: the answer, and how accurate the survey is.
///
/// The answer is for the operator who is still in the field.

#include <optional>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "corrector/model/corrected_survey.hpp"

namespace a351::corrector::report {

/// Returns the standard error of an RMS, RMS / sqrt(2 dof), in mGal; std::nullopt without a degree
/// of freedom or without an RMS.
///
/// dof includes priors and datum; for a network it is that of the adjustment.  A smaller difference
/// between the RMS of two models is not significant.
[[nodiscard]] std::optional<double> standard_error_of_rms(const model::Score& score);

/// Returns a sentence on the uncertainty of the scatter.
[[nodiscard]] std::string scatter_sentence(const model::Score& score);

/// Adds the first sentences (result::answer()), the mistakes that were found, headlines in bold, and
/// lines on missing figures.
void add_answer(pugi::xml_node parent, const model::SurveyCorrection& result,
                const std::vector<std::string>& missing);

/// Adds the line of each station (result::answer_table()).
void add_answer_table(pugi::xml_node parent, const model::SurveyCorrection& result);

/// Adds the notes (result::notes()), the remarks, and the amendments to paste.
/// @param warning_count  number of warnings about the input; above 0 the last section is named.
void add_notes(pugi::xml_node parent, const model::SurveyCorrection& result,
               std::size_t warning_count);

/// Adds a description of the survey, the uncertainty of its scatter, and its scales.
void add_accuracy(pugi::xml_node parent, const model::SurveyCorrection& result);

}  // namespace a351::corrector::report
