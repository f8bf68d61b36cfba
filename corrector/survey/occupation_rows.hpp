#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "corrector/day/day_record.hpp"
#include "corrector/signal/representative_value.hpp"
#include "corrector/survey/amendments.hpp"
#include "corrector/survey/occupation_list.hpp"
#include "corrector/survey/on_all_cores.hpp"
#include "corrector/survey/result_files.hpp"
#include "corrector/survey/survey_file.hpp"
#include "corrector/survey/survey_row.hpp"
#include "corrector/survey/temperature_course.hpp"

namespace a351::corrector {

struct OccupationRows {
    std::vector<SurveyRow> rows;  ///< With tide and the rate within the interval; by time.
    std::vector<RepresentativeValue> records;           ///< Behind the rows, one each.
    std::vector<MinuteTemperature> temperature_course;  ///< Over the whole survey.
    std::optional<DayRecord> day;       ///< Set-ups numbered as the rows; absent: no temperature.
    std::vector<LeftOut> left_out;      ///< Occupations without a value, by start.
    std::vector<std::string> warnings;  ///< What is doubtful or left out, and why.
    std::vector<Amendment> amendments;
    std::vector<text::Site> sites;
    std::vector<InputFile> inputs;  ///< Every file read.
    std::string serial_number;      ///< Of the sensor; empty: the metadata do not tell.
};

/// The representative value of a record as a row of the survey, reference and tide left open.
/// @param value  with a temperature.
[[nodiscard]] SurveyRow row_of(const OccupationWindow& window, const RepresentativeValue& value);

/// The options without a base or datum stations that have no row, each with a warning; as they are
/// where the result would be another: for `paper`, whose drift step needs the base, and when no datum
/// station would be left.
[[nodiscard]] SurveyOptions with_sites_of(OccupationRows& read, SurveyOptions options);

/// Reads the record of a survey and averages every occupation, on all cores.  The result does not
/// depend on their number.
/// @throws InputError  metadata or occupations cannot be read; no occupation has a value; the
///                     calibration is of another unit.
[[nodiscard]] OccupationRows average_occupations(const SurveyFile& survey,
                                                 const Progress& progress);

}  // namespace a351::corrector
