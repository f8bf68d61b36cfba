#pragma once
/// @file
/// Names of readings in figures and reports.
///
/// A name is unique within a survey, so that a table, a figure and a warning mean the same reading.

#include <string>
#include <vector>

#include "corrector/model/corrected_survey.hpp"

namespace a351::corrector::judgement {

/// Returns "SITE (OCCUPATION)"; if the stay has several set-ups, with a letter: "SITE (2b)".
///
/// Letters count the rows of the stay in the order of `rows`; after z there are numbers: "SITE (2-27)".
/// The name of the site is as given.  O(n) for n rows.
/// @param index  below rows.size(); not checked.
[[nodiscard]] std::string reading_name(const std::vector<model::CorrectedRow>& rows,
                                       std::size_t index);

/// Returns the name of the stay of a row, as "No.5 (2)", with the gravimeter if there is one.
[[nodiscard]] std::string stay_name(const reading::SurveyRow& row);

}  // namespace a351::corrector::judgement
