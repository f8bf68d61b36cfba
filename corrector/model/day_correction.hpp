#pragma once
/// @file
/// The whole-day model (corrector/whole_day) as a model of a survey.

#include <optional>
#include <string>
#include <vector>

#include "corrector/model/survey_correction.hpp"
#include "corrector/reading/day_record.hpp"

namespace a351::corrector {

/// Why the whole-day model cannot be fitted to these rows; std::nullopt when it can.
/// @param in_use         one per row.
/// @param is_calibrated  says_of_day(): what few rows cannot say is known: one will do.
[[nodiscard]] std::optional<std::string> day_refusal(const std::vector<SurveyRow>& rows,
                                                     const std::vector<bool>& in_use,
                                                     const DayRecord* day, bool is_calibrated);

/// Rows with a reference that may enter a fit, one flag per row.
struct DayRowSets {
    std::vector<bool> all;   ///< Flagged ones too.
    std::vector<bool> used;  ///< Not flagged.
};

/// Fills in what the model gives.  Acceleration and temperature of a row become means of its bins,
/// start and end those of their samples; its time stays, for its tide is of that instant.  A row's
/// uncertainty is that of its station when its reference is not known, and its studentised residual
/// the error of that prediction over it: found by fitting anew without each station.  Flagged rows,
/// which the fit leaves out, stand for stations of their own.
/// @param result  with options, rows, row sets and `model`; day_refusal() found nothing.
void correct_by_day(SurveyCorrection& result, const DayRowSets& sets, const DayRecord& day);

}  // namespace a351::corrector
