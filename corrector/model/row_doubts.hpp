#pragma once
/// @file
/// Doubts about the rows of a fit, as text.  No row is left out because of them.

#include <string>
#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::model {

/// Distance from the temperatures of the fit that is not worth a remark, degC.  Reason: it is twice
/// the swing of the oven, and 1.5 mGal at the published -29 mGal/degC.
inline constexpr double kOutsideTemperature_degc = 0.05;

/// Returns the doubtful rows with their reasons, one per line, or a line that there are none.
///
/// The order is that of the rows.  The text ends with a newline.
/// @param result  with doubts set, as correct_survey() returns it.
[[nodiscard]] std::string doubts_text(const SurveyCorrection& result);

/// Returns a remark on readings of unknown stations whose temperature is outside that of the
/// readings in the fit at known stations, by more than kOutsideTemperature_degc; empty if there are
/// none, or if the rows have no temperature.
///
/// The temperature correction of such a reading is extrapolated: an error of the coefficient acts
/// on the whole distance.
/// @param rows   rows of the fit.
/// @param datum  stations whose reference is held; empty: all.
[[nodiscard]] text::Message temperature_remark(const std::vector<CorrectedRow>& rows,
                                               const std::vector<std::string>& datum);

}  // namespace a351::corrector::model
