#pragma once
/// @file
/// A corrected survey as text for people.

#include <string>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// Returns the reasons why a row is doubtful or not in the fit, joined by ';'.
[[nodiscard]] std::string flags_of(const CorrectedRow& row, const SurveyOptions& options);

/// Returns the reason as a flag, with '-' for each space.
[[nodiscard]] std::string flag_of(const LeftOut& occupation);

/// Returns true if this score is that of the applied model on the rows of its fit.
[[nodiscard]] bool is_selected(const SurveyCorrection& result, const ScoredRowSet& set,
                               const ModelScore& score);

/// Returns model, rows, n, p, degrees of freedom, RMS and s in sample, RMS of rows and of stations
/// left out, AICc.
[[nodiscard]] std::vector<std::string> score_cells(const ScoredRowSet& set,
                                                   const ModelScore& score);

/// Returns aligned tables of occupations, stations and models.  Each root mean square is marked as
/// in sample or cross-validated.
[[nodiscard]] std::string survey_text(const SurveyCorrection& result);

}  // namespace a351::corrector
