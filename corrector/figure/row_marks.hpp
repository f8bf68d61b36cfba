#pragma once
/// @file
/// Marks that distinguish the rows of a survey in its figures.

#include <functional>
#include <string>
#include <vector>

#include "corrector/model/corrected_survey.hpp"

namespace a351::corrector::figure {

/// A group of rows and its mark in a figure.
struct Mark {
    std::string title;
    std::function<bool(const model::CorrectedRow&)> takes;
    std::string style;
};

/// Returns the groups: in the fit, marked by the operator but in the fit, left out of the fit.  Each
/// row is in one of them.  The list lives as long as the program.
[[nodiscard]] const std::vector<Mark>& marks();

/// Returns the end of a line of data: a comment with the name of the row's reading.
[[nodiscard]] std::string comment(const model::SurveyCorrection& result, std::size_t row);

}  // namespace a351::corrector::figure
