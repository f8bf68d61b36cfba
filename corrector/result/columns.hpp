#pragma once
/// @file
/// The columns of occupations.csv, stations.csv, differences.csv and models.csv, in their order.
/// result.json has the same rows with the same keys.  table-format.md explains each column.
///
///     const auto columns = occupation_columns(result);
///     const std::string csv = csv_table(columns, result.rows);  // without result.left_out
///     const auto few = with_keys(columns, {"site", "corrected_mgal"});
///
/// Keys end with their unit: _mgal, _degc, _degc_per_h, _g, _s.  Refer to a column by its key: the
/// order may change, and further columns may be added.

#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "corrector/result/column.hpp"
#include "corrector/result/table_text.hpp"

namespace a351::corrector::result {

/// Returns the minutes that a reading averages: those between its limits, for `day` those of the
/// undisturbed samples; nothing for a table of averages.
[[nodiscard]] std::optional<double> used_minutes(const model::CorrectedRow& row);

/// Returns the columns of occupations.csv.  An occupation without a value has only the first seven,
/// from the site to the flags, and the last two, its grade.  Rows from records and rows of the whole-day model have more
/// columns.
///
/// The first row of the result decides which columns there are (columns_test.cpp).  All rows must
/// therefore be of one kind, as correct_survey() gives them.  Cells of other models are empty.
/// @param result  must outlive the columns and have at least one row.
[[nodiscard]] std::vector<Column<model::CorrectedRow>> occupation_columns(
    const model::SurveyCorrection& result);

/// Returns the columns of stations.csv.  They are the same for every model; cells that a model does
/// not give are empty.  The columns of anomalies are present if a station has anomalies.
[[nodiscard]] std::vector<Column<model::StationValue>> station_columns(
    const std::vector<model::StationValue>& stations);

/// Returns the columns of differences.csv.
[[nodiscard]] std::vector<Column<model::StationDifference>> difference_columns();

/// Returns the columns of models.csv, for the rows of score_rows().  The pointers in a row must not
/// be null.
/// @param result  must outlive the columns.
[[nodiscard]] std::vector<Column<ScoreRow>> score_columns(const model::SurveyCorrection& result);

}  // namespace a351::corrector::result
