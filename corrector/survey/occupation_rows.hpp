#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "corrector/day/day_record.hpp"
#include "corrector/signal/representative_value.hpp"
#include "corrector/survey/occupation_list.hpp"
#include "corrector/survey/on_all_cores.hpp"
#include "corrector/survey/result_files.hpp"
#include "corrector/survey/survey_file.hpp"
#include "corrector/survey/survey_row.hpp"

namespace a351::corrector {

struct OccupationRows {
    std::vector<SurveyRow> rows;        ///< With tide and the rate within the interval; by time.
    std::optional<DayRecord> day;       ///< Set-ups numbered as the rows; absent: no temperature.
    std::vector<std::string> warnings;  ///< Occupations without a value, and why.
    std::vector<InputFile> inputs;      ///< Every file read.
};

/// The representative value of a record as a row of the survey, reference and tide left open.
/// @param value  with a temperature.
[[nodiscard]] SurveyRow row_of(const OccupationWindow& window, const RepresentativeValue& value);

/// Reads the record of a survey and averages every occupation, on all cores.  The result does not
/// depend on their number.
/// @throws InputError  metadata or occupations cannot be read; no occupation has a value.
[[nodiscard]] OccupationRows average_occupations(const SurveyFile& survey,
                                                 const Progress& progress);

}  // namespace a351::corrector
