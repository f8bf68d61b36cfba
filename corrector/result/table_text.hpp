#pragma once
/// @file
/// A corrected survey as text for people.

#include <functional>
#include <string>
#include <vector>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// Returns the reasons why a row is doubtful or not in the fit, joined by ';'.
[[nodiscard]] std::string flags_of(const CorrectedRow& row, const SurveyOptions& options);

/// Returns the reason as a flag, with '-' for each space.
[[nodiscard]] std::string flag_of(const LeftOut& occupation);

/// Calls `row` with the index of each row, and `left_out` with each occupation without a row, in
/// order of time.
void in_order_of_time(const SurveyCorrection& result, const std::function<void(std::size_t)>& row,
                      const std::function<void(const LeftOut&)>& left_out);

/// A model and the rows that it was fitted to.
struct ScoreRow {
    const ScoredRowSet* set = nullptr;
    const ModelScore* score = nullptr;
};

/// Returns the scores of all models, set by set.
[[nodiscard]] std::vector<ScoreRow> score_rows(const SurveyCorrection& result);

/// Returns true if this score is that of the applied model on the rows of its fit.
[[nodiscard]] bool is_selected(const SurveyCorrection& result, const ScoreRow& row);

/// Returns model, rows, n, p, degrees of freedom, RMS and s in sample, RMS of rows and of stations
/// left out, AICc.
[[nodiscard]] std::vector<std::string> score_cells(const ScoreRow& row);

/// Returns aligned tables of occupations, stations and models.  Each root mean square is marked as
/// in sample or cross-validated.
[[nodiscard]] std::string survey_text(const SurveyCorrection& result);

}  // namespace a351::corrector
