#pragma once

#include <string>
#include <vector>

#include "corrector/job/survey_file.hpp"
#include "corrector/reading/occupation_rows.hpp"

namespace a351::corrector {

/// Reads the record of a survey, averages every occupation and sets its tide.
/// @throws InputError  metadata or occupations cannot be read; no occupation has a value; the
///                     calibration is of another unit; the tide is not known for all readings.
[[nodiscard]] OccupationRows read_survey(const SurveyFile& survey, const Progress& progress);

/// Removes a base and datum stations that have no row from the options, each with a warning.  The base of
/// `paper` stays, because its drift step needs it; the datum stays if no station of it would be left.
[[nodiscard]] SurveyOptions with_sites_of(OccupationRows& read, SurveyOptions options);

/// Returns the doubts about the survey's calibration, one sentence each.
/// @param serial_number  of the record; empty: not known.
/// @throws InputError  it is of another unit.
[[nodiscard]] std::vector<std::string> check_calibration(
    const SurveyFile& survey, const std::string& serial_number,
    const std::vector<OccupationWindow>& windows);

}  // namespace a351::corrector
