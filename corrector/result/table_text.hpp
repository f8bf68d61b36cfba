#pragma once
/// @file
/// A corrected survey as text for people, and helpers that the tables for programs share.
///
///     std::cout << survey_text(result, false);
///
/// The text may change from version to version.  Programs read the files of result_files.hpp.

#include <functional>
#include <string>
#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "corrector/result/column.hpp"

namespace a351::corrector::result {

/// Returns the reasons why a row is doubtful or not in the fit, joined by ';'.
///
/// The order is "outlier" (marked by the operator), SurveyRow::notes, then "no-reference",
/// "reference-not-used" (by an amendment) or "not-datum".  The last one means that a list of datum stations is given and lacks the site.
/// Empty: there is no reason.
[[nodiscard]] std::string flags_of(const model::CorrectedRow& row,
                                   const model::SurveyOptions& options);

/// Returns the reason as a flag, with '-' for each space: "no samples" gives "no-samples".
[[nodiscard]] std::string flag_of(const reading::LeftOut& occupation);

/// Calls `row` with the index of each row, and `left_out` with each occupation without a row, in
/// order of time.
///
/// Every row and every left-out occupation is visited once.  A row is placed by its `time`, a
/// left-out occupation by its `start`; at equal instants the row is first.
/// @param result    rows in ascending time; left_out sorted by start, as add_left_out() does.
/// @param row       takes an index into result.rows.
/// @param left_out  takes an element of result.left_out.
void in_order_of_time(const model::SurveyCorrection& result,
                      const std::function<void(std::size_t)>& row,
                      const std::function<void(const reading::LeftOut&)>& left_out);

/// Returns why `auto` took the model, as " (chosen because ...)"; empty if the user chose it.
[[nodiscard]] std::string choice_text(const model::SurveyCorrection& result);

/// A model and the rows that it was fitted to.  The pointers are into a SurveyCorrection, which
/// must outlive them; they are null only in a default-constructed object.
struct ScoreRow {
    const model::ScoredRowSet* set = nullptr;
    const model::Score* score = nullptr;
};

/// Returns the scores of all models, set by set: first the unflagged rows, then all rows.
/// @param result  must outlive the returned pointers, and its row_sets must not change.
[[nodiscard]] std::vector<ScoreRow> score_rows(const model::SurveyCorrection& result);

/// Returns true if this score is that of the applied model on the rows of its fit.  These are the
/// set "used" with SurveyOptions::use_flags, else "all".
[[nodiscard]] bool is_selected(const model::SurveyCorrection& result, const ScoreRow& row);

/// Returns the values of the stations; flagged_only is shown only if it is true for a station.
[[nodiscard]] Table stations_table(const model::SurveyCorrection& result);

/// Returns the sources of the stations' uncertainties; no rows unless `day` is applied.
[[nodiscard]] Table budget_table(const model::SurveyCorrection& result);

/// Returns the scores of all models, without columns in which no model has a value.
[[nodiscard]] Table models_table(const model::SurveyCorrection& result);

/// Returns the survey for the terminal: the answer, the findings, a line per station, what must be
/// known, the remarks.
///
/// Lines have at most 118 columns, and end with LF.
/// @param result      at least one row; order as for in_order_of_time().
/// @param is_verbose  adds the tables of readings, stations and models, the coefficients, and what
///                    is to be said about them.  Each root mean square is marked as in sample or
///                    cross-validated (result_files_test.cpp).
[[nodiscard]] std::string survey_text(const model::SurveyCorrection& result, bool is_verbose);

}  // namespace a351::corrector::result
