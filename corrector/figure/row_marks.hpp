#pragma once
/// @file
/// Marks that distinguish the rows of a survey in its figures.

#include <functional>
#include <string>

#include "corrector/figure/figure.hpp"
#include "corrector/model/corrected_survey.hpp"

namespace a351::corrector::figure {

/// Adds the rows to the first panel, in a block for each kind: in the fit, marked by the operator but
/// in the fit, left out of the fit.  A line ends with the name of its row as a comment.
/// @param columns  names of the columns.
/// @param line_of  returns the numbers of a row; empty if it is not in the figure.
void plot_rows(Figure& figure, const model::SurveyCorrection& result, const std::string& columns,
               const std::function<std::string(const model::CorrectedRow&)>& line_of);

/// Adds error bars below the marks of a panel; their data have u in the third column.
void add_bars(Panel& panel);

/// Returns the end of a line of data: a comment with the name of the row's reading.
[[nodiscard]] std::string comment(const model::SurveyCorrection& result, std::size_t row);

}  // namespace a351::corrector::figure
