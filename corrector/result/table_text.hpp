#pragma once
/// @file
/// A corrected survey as text for people.

#include <string>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// Reasons why a row is doubtful or not in the fit, joined by ';'.
[[nodiscard]] std::string flags_of(const CorrectedRow& row, const SurveyOptions& options);

/// The reason as a flag.
[[nodiscard]] std::string flag_of(const LeftOut& occupation);

/// Whether this score is that of the applied model on the rows of its fit.
[[nodiscard]] bool is_selected(const SurveyCorrection& result, const ScoredRowSet& set,
                               const ModelScore& score);

/// Model, rows, n, p, RMS and s in sample, RMS of rows and of stations left out, AICc.
[[nodiscard]] std::vector<std::string> score_cells(const ScoredRowSet& set,
                                                   const ModelScore& score);

/// Aligned tables of occupations, stations and models.  Each root mean square says whether it is
/// in sample or cross-validated.
[[nodiscard]] std::string survey_text(const SurveyCorrection& result);

}  // namespace a351::corrector
