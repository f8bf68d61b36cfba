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

/// The options without a base or datum stations that have no row, each with a warning; as they are
/// where the result would be another: for `paper`, whose drift step needs the base, and when no datum
/// station would be left.
[[nodiscard]] SurveyOptions with_sites_of(OccupationRows& read, SurveyOptions options);

/// What is doubtful about the survey's calibration, in sentences.
/// @param serial_number  of the record; empty: not told.
/// @throws InputError  it is of another unit.
[[nodiscard]] std::vector<std::string> check_calibration(
    const SurveyFile& survey, const std::string& serial_number,
    const std::vector<OccupationWindow>& windows);

}  // namespace a351::corrector
