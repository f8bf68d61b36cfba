#pragma once
/// @file
/// The columns of occupations.csv, stations.csv and models.csv, in their order.  result.json has
/// the same rows with the same keys.  table-format.md explains each column.

#include <vector>

#include "corrector/model/survey_correction.hpp"
#include "corrector/result/column.hpp"
#include "corrector/result/table_text.hpp"

namespace a351::corrector {

/// Returns the columns of occupations.csv.  An occupation without a value has only the first seven,
/// from the site to the flags.  Rows from records and rows of the whole-day model have more
/// columns.
/// @param result  must outlive the columns and have at least one row.
[[nodiscard]] std::vector<Column<CorrectedRow>> occupation_columns(const SurveyCorrection& result);

/// Returns the columns of stations.csv.
[[nodiscard]] std::vector<Column<StationValue>> station_columns();

/// Returns the columns of models.csv.
/// @param result  must outlive the columns.
[[nodiscard]] std::vector<Column<ScoreRow>> score_columns(const SurveyCorrection& result);

}  // namespace a351::corrector
