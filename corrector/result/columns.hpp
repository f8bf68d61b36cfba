#pragma once
/// @file
/// The columns of occupations.csv, stations.csv and models.csv, in their order; table-format.md explains each.
/// result.json has the same rows with the same keys.

#include <vector>

#include "corrector/model/survey_correction.hpp"
#include "corrector/result/column.hpp"

namespace a351::corrector {

/// The first seven, from the site to the flags, are those that a left-out occupation has too.
/// @param result  outlives the columns; has at least one row.  Rows from records and rows of the whole-day model have more columns.
[[nodiscard]] std::vector<Column<CorrectedRow>> occupation_columns(const SurveyCorrection& result);

[[nodiscard]] std::vector<Column<StationValue>> station_columns();

/// A model and the rows that it was fitted to.
struct ScoreRow {
    const ScoredRowSet* set = nullptr;
    const ModelScore* score = nullptr;
};

/// @param result  outlives the columns.
[[nodiscard]] std::vector<Column<ScoreRow>> score_columns(const SurveyCorrection& result);

}  // namespace a351::corrector
