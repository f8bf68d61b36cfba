#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "corrector/signal/representative_value.hpp"
#include "corrector/survey/occupation_list.hpp"
#include "corrector/survey/result_files.hpp"
#include "corrector/survey/survey_file.hpp"
#include "corrector/survey/survey_row.hpp"

namespace a351::corrector {

struct OccupationRows {
    std::vector<SurveyRow> rows;        ///< With tide and the rate within the interval; by time.
    std::vector<std::string> warnings;  ///< Occupations without a value, and why.
    std::vector<InputFile> inputs;      ///< Every file read.
};

/// Called now and then with the number of occupations done and in all, from any thread but never
/// from two at once; does not throw.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

/// The representative value of a record as a row of the survey, reference and tide left open.
/// @param value  with a temperature.
[[nodiscard]] SurveyRow row_of(const OccupationWindow& window, const RepresentativeValue& value);

/// Reads the record of a survey and averages every occupation, on all cores.  The result does not
/// depend on their number.
/// @throws InputError  metadata or occupations cannot be read; no occupation has a value.
[[nodiscard]] OccupationRows average_occupations(const SurveyFile& survey,
                                                 const Progress& progress);

}  // namespace a351::corrector
