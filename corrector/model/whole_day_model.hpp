#pragma once
/// @file
/// The whole-day model (corrector/whole_day) as a model of a survey.
///
/// Use it for surveys with records; `auto` takes it whenever it can.  With averages only, use a
/// linear model.  The formula is in day_model.hpp.

#include <optional>
#include <vector>

#include "corrector/model/model.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::model {

/// Returns the reason why the whole-day model cannot be fitted to these rows; std::nullopt if it
/// can.
///
/// It needs a record of the day, a row in use, no gap of the temperature longer than 6 h, and a bin
/// in every set-up.
///
/// The bin is required of flagged and excluded rows too.  If several things are missing, the first
/// of this list is given.  whole_day_model() refuses priors of slopes in addition.
/// @param rows    (n), one per set-up, in the order of the record.
/// @param in_use  (n) rows of the fit, each with a reference.
/// @param day     record of these rows; null: there is none.
[[nodiscard]] std::optional<text::Message> day_refusal(const std::vector<reading::SurveyRow>& rows,
                                                       const std::vector<bool>& in_use,
                                                       const reading::DayRecord* day);

/// The whole-day model:
///
/// - Acceleration and temperature of a row become means over its bins; start and end become the
///   times of their first and last sample.  Its time does not change, because its tide belongs to
///   that time.
/// - The adjustment is repeated without each station, and lags and noise are searched again.
///   u_corrected is the uncertainty of the row if the reference of its station is unknown.  The
///   studentised residual is the error of this prediction divided by
///   sqrt(u_corrected^2 + u_reference^2).
/// - A row that is excluded, or flagged and not used, gets its own unknown station, so that it has
///   a value and no influence.
/// - If only one station is held, its rows have no such prediction: neither u_corrected nor a
///   studentised residual.  There is no LOSO then.
/// - A station without an accepted row has the mean of its rows.  Its uncertainty neglects that the
///   errors of these rows are correlated.
/// - A remark gives the part of the temperature slope that comes from the prior, if it is more than
///   a quarter.  Another one gives the missing time of the temperature, if it is more than 5 min.
/// - goodness_of_fit() tests the fit.  A misfit is a remark, and enlarges the uncertainties of stations
///   and differences by the rms of the studentised residuals.
/// - The slow term needs two hours of temperature before the first bin.  There is a remark if the
///   record begins later.
/// - With a calibration the fit is repeated with the usual priors, and the use of the calibration
///   is reported (calibration_use.hpp).
///
/// The prediction without a station agrees within 0.01 mGal with hiding its reference, and
/// u_corrected within 1 % (whole_day_model_test.cpp); within 0.02 mGal on simulated days
/// (tests/bench/survey_accuracy.py).
///
/// It refuses as day_refusal(), and if the options have priors of slopes, which it would ignore.
///
/// score() is nullopt where it refuses.
///
/// Cost: one search for the most likely noise and lags for each held station, on all cores, and one
/// for all rows; twice as much with a calibration.
[[nodiscard]] Model whole_day_model();

}  // namespace a351::corrector::model
