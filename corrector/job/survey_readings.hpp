#pragma once
/// @file
/// The readings of a survey file.

#include <string>
#include <vector>

#include "corrector/job/survey_file.hpp"
#include "corrector/reading/occupation_rows.hpp"

namespace a351::corrector {

/// Reads the record of a survey, averages every occupation and sets its tide.
/// @throws InputError  metadata or occupations cannot be read; no occupation has a value; the
///                     calibration is of another unit; the tide is not known for all readings.
[[nodiscard]] OccupationRows read_survey(const SurveyFile& survey, const Progress& progress);

/// Removes the base and datum stations without a row from the options, with a warning for each.
/// The base of `paper` is kept, because its drift step needs it.  The datum is kept if none of its
/// stations would be left.
[[nodiscard]] SurveyOptions with_sites_of(OccupationRows& read, SurveyOptions options);

/// Returns the doubts about the survey's calibration, one sentence each.
/// @param serial_number  serial number of the record's sensor; empty: not known.
/// @throws InputError  the calibration is of another unit.
[[nodiscard]] std::vector<std::string> check_calibration(
    const SurveyFile& survey, const std::string& serial_number,
    const std::vector<OccupationWindow>& windows);

}  // namespace a351::corrector
