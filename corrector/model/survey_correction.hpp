#pragma once
/// @file
/// From rows to gravity: fits one model, corrects every row and scores all models.
///
/// Tide and rates of the rows must be set before:
///
///     std::vector<SurveyRow> rows = read_observations(file, sites);  // with backward rates
///     apply_tide(rows, sites, tide);
///     SurveyOptions options;
///     options.model = "t-rate";
///     const SurveyCorrection result = correct_survey(rows, options);
///
/// With the calibration of a unit call correct_with_calibration() instead, which takes the same
/// arguments.  With records add the occupations without a row afterwards, by add_left_out().

#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "corrector/reading/day_record.hpp"

namespace a351::corrector::model {

/// Adds occupations that have no row, and sorts them by start.
///
/// Occupations that the model itself left out remain, and are sorted among them.  No value of the
/// correction changes.
void add_left_out(SurveyCorrection& result, const std::vector<reading::LeftOut>& occupations);

/// Corrects a survey by the model of the options.
///
/// Rows in the fit have a reference, belong to the datum, are not excluded and, with use_flags, not
/// flagged.  All other rows are corrected too and have no influence.  A calibration is not applied
/// to the readings here, except as prior of the whole-day model: see correct_with_calibration().
///
/// `auto` takes the whole-day model unless it refuses, or unless stations left out are predicted
/// significantly worse than by a linear model; else choose_model(); without a choice the network,
/// with adjustment::add_published_priors().  `network` with a record is the whole-day model, unless that
/// refuses.  If there is a record, a remark says why the whole-day model is not used.
///
/// The result has scores of each model that is always scored, and of the applied one.  They are for
/// two row sets: without the flagged rows, and with them.
///
/// The same arguments give the same result.  Several threads may call it at a time; the whole-day
/// model uses all cores for one call.
///
/// Accuracy (survey_correction_test.cpp): the corrections add up to the corrected value within
/// 1e-8 mGal; an unknown station of a day without noise comes out within 1e-6 mGal.
/// @param rows     (n) in strictly ascending time, with tide and rates set; finite.  All rows of a
///                 station have the same reference, or none.
/// @param options  see SurveyOptions.  An empty base becomes the station of the first row.
/// @param day      record of these rows, for the model `day`; null: there are only averages.
/// @throws reading::Refused  the model refuses the rows, or there is one row only.
/// @throws InputError        a base or datum station has no row, the model is unknown, or there are
///                           no rows.
[[nodiscard]] SurveyCorrection correct_survey(const std::vector<reading::SurveyRow>& rows,
                                              const SurveyOptions& options,
                                              const reading::DayRecord* day = nullptr);

}  // namespace a351::corrector::model
