#pragma once
/// @file
/// The tables of a report, as HTML.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "corrector/model/survey_correction.hpp"
#include "protocol/text/input_file.hpp"

namespace a351::corrector {

/// Returns the values of the stations.
[[nodiscard]] std::string stations_html(const SurveyCorrection& result);

/// Returns the table of all readings with every correction, and an explanation of its columns.  The
/// columns are those of the model.  Occupations without a value have a row too.
[[nodiscard]] std::string occupations_html(const SurveyCorrection& result);

/// Returns a table of the difference between readings of one station, before and after each
/// correction; a sentence if no station was read twice.
[[nodiscard]] std::string closures_html(const SurveyCorrection& result);

/// Returns the scores of all models, and the coefficients of the applied one.
[[nodiscard]] std::string models_html(const SurveyCorrection& result);

/// Returns warnings, settings, and inputs with their checksums.
[[nodiscard]] std::string provenance_html(const nlohmann::ordered_json& settings,
                                          const std::vector<text::InputFile>& inputs,
                                          const std::vector<std::string>& warnings);

}  // namespace a351::corrector
