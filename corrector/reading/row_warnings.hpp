#pragma once
/// @file
/// Warnings about rows that do not fit the others, or whose site is not known well enough.

#include <vector>

#include "corrector/reading/survey_row.hpp"

namespace a351::corrector::reading {

/// Returns a warning for every site of the rows without a known position, once per site, in order
/// of the rows.  The site has the mean position of the others, which is good enough for the tide
/// and not for a map.  A site that is not in the table gets no warning.
[[nodiscard]] std::vector<text::Message> position_warnings(const std::vector<SurveyRow>& rows,
                                                           const std::vector<text::Site>& sites);

/// Returns warnings about rows of a table that do not fit the others:
/// - each row that is more than 20 days from all others, as with a mistyped year or month;
/// - each row whose temperature is more than 10 degC from the median, and 20 times as far as half of
///   the rows are, as with 0 for an empty cell;
/// - the first row that comes less than 8 h after a row of its site and loop with a larger number, as
///   with the hours of a 12-hour clock.  A table may count the stays of each day anew.
///
/// Rows of the first two kinds are not named if more than a quarter of the rows are of one.
/// @param rows  in order of time.
[[nodiscard]] std::vector<text::Message> row_warnings(const std::vector<SurveyRow>& rows);

}  // namespace a351::corrector::reading
