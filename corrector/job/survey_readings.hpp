#pragma once
/// @file
/// The readings of a survey file.
///
/// The steps from a survey file to gravity, in order:
///
///     OccupationRows read = read_survey(survey, progress);
///     const SurveyOptions options = with_sites_of(read, survey.survey);
///     SurveyCorrection result = correct_with_calibration(
///         read.rows, options, read.day ? &*read.day : nullptr);  // calibration_use.hpp
///     add_left_out(result, read.left_out);
///
/// Doubts do not stop a step: they are sentences in OccupationRows::warnings.  Show all of them to
/// the user at the end.

#include <string>
#include <vector>

#include "corrector/job/survey_file.hpp"
#include "corrector/reading/occupation_rows.hpp"

namespace a351::corrector::job {

/// Reads the record of a survey, averages every occupation and sets its tide.
///
/// The occupations are averaged on all cores; this takes most of the time of a survey.  The result
/// does not depend on their number.  The calibration is checked before any sample is read.
///
/// `inputs` of the result has every file that was read, the survey file first.  Warnings about the
/// calibration are the first warnings.
/// @param survey    as read_survey_file() gives it.  Without a path, as from a data root alone, no
///                  survey file is among the inputs.
/// @param progress  called with the occupations done and of all, from any thread, one at a time.
/// @throws InputError  metadata or occupations cannot be read; no occupation has a value; the
///                     calibration is of another unit; the tide is not known for all readings.
[[nodiscard]] reading::OccupationRows read_survey(const SurveyFile& survey,
                                                  const archive_series::Progress& progress);

/// Completes the options of a survey with what its readings allow: sets the steps of the amendments
/// that divide the readings, and removes base and datum stations without a row, with a warning for
/// each.
///
/// The base of `paper` is kept, because its drift step needs it.  The datum is kept if none of its
/// stations would be left.
///
/// Call it before the correction, which refuses a base or datum station without a row.  If the base
/// is removed, the correction takes the site of the first row.
/// @param read     its warnings grow; nothing else changes.
/// @param options  options of the survey file; the changed copy is returned.
[[nodiscard]] model::SurveyOptions with_sites_of(reading::OccupationRows& read,
                                                 model::SurveyOptions options);

/// Returns the doubts about the survey's calibration, one sentence each.
///
/// Doubts are a record without a serial number, and a survey that begins before or ends after the
/// validity of the calibration (survey_readings_test.cpp).  An empty list means that neither is
/// the case.
/// @param survey         with a calibration, else std::bad_optional_access is thrown.
/// @param serial_number  serial number of the record's sensor; empty: not known.
/// @param windows        occupations in order of start, at least one.
/// @throws InputError  the calibration is of another unit.
[[nodiscard]] std::vector<text::Message> check_calibration(
    const SurveyFile& survey, const std::string& serial_number,
    const std::vector<reading::OccupationWindow>& windows);

}  // namespace a351::corrector::job
