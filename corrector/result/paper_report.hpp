#pragma once
/// @file
/// Table 2 of the publication for the model `paper` (paper_correction.hpp), for report and terminal.
///
///     if (is_paper(result)) std::cout << aligned_text(paper_table(result)) << paper_errors(result);

#include <string>

#include "corrector/model/corrected_survey.hpp"
#include "corrector/result/table.hpp"

namespace a351::corrector::result {

/// Returns true if the rows were corrected by the model `paper`.
[[nodiscard]] bool is_paper(const model::SurveyCorrection& result);

/// Returns the columns of Table 2 for every reading, in its order and with its three decimals: site,
/// reference, time, tide, averaged acceleration and temperature, difference, Corrected (1), Error
/// (1), Corrected (2), Error (2).  The last column says whether a reading is in the fit.
///
/// Errors are reference - corrected, as printed there.
[[nodiscard]] Table paper_table(const model::SurveyCorrection& result);

/// Returns the rms of both errors over the readings in the fit that have a reference.
[[nodiscard]] std::string paper_errors(const model::SurveyCorrection& result);

}  // namespace a351::corrector::result
