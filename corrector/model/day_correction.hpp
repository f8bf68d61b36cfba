#pragma once
/// @file
/// The whole-day model (corrector/whole_day) as a model of a survey.

#include <optional>
#include <string>
#include <vector>

#include "corrector/model/survey_correction.hpp"
#include "corrector/reading/day_record.hpp"

namespace a351::corrector {

/// Returns the reason why the whole-day model cannot be fitted to these rows; std::nullopt if it
/// can.
///
/// It needs a record of the day, at least six rows in use (one if `is_calibrated`), no gap of the
/// temperature longer than 30 min, and a bin in every set-up.
/// @param rows           (n), one per set-up, in the order of the record.
/// @param in_use         (n) rows of the fit, each with a reference.
/// @param day            record of these rows; null: there is none.
/// @param is_calibrated  helps_to_correct_day(): terms that few rows cannot determine are calibrated.
[[nodiscard]] std::optional<std::string> day_refusal(const std::vector<SurveyRow>& rows,
                                                     const std::vector<bool>& in_use,
                                                     const DayRecord* day, bool is_calibrated);

/// Rows with a reference that may enter a fit; one flag per row.
struct DayRowSets {
    std::vector<bool> all;   ///< All such rows, flagged or not.
    std::vector<bool> used;  ///< Rows that are not flagged.
};

/// Corrects a survey by the whole-day model: fills rows, coefficients, stations, scores and
/// remarks.
///
/// - Acceleration and temperature of a row become means over its bins; start and end become the
///   times of their first and last sample.  Its time does not change, because its tide belongs to
///   that time.
/// - The fit is repeated without each station.  u_corrected is the uncertainty that the row has if
///   the reference of its station is unknown.  The studentised residual is the error of this
///   prediction divided by u_corrected.
/// - A row that is excluded, or flagged and not used, gets its own unknown station, so that it has
///   a value and no influence.
/// - With a calibration the fit is repeated with the usual priors, and the use of the calibration
///   is reported (calibration_use.hpp).
///
/// The prediction without a station agrees within 0.01 mGal with hiding its reference, and
/// u_corrected within 1 % (day_correction_test.cpp).
/// @param result  survey with options, rows, row sets and model; day_refusal() returned
///                std::nullopt.
/// @param sets    rows for the scores; `used` or `all` is the fit, as the options say.
/// @param day     record of these rows.
void correct_by_day(SurveyCorrection& result, const DayRowSets& sets, const DayRecord& day);

}  // namespace a351::corrector
