#pragma once
/// @file
/// The tables and the JSON of a corrected survey.  Two runs give the same bytes.
/// Columns and keys: table-format.md.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "corrector/model/survey_correction.hpp"
#include "protocol/text/input_file.hpp"
#include "protocol/text/sites.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector {

/// Returns the content of occupations.csv.
[[nodiscard]] std::string occupations_csv(const SurveyCorrection& result);
/// Returns the content of stations.csv.
[[nodiscard]] std::string stations_csv(const SurveyCorrection& result);
/// Returns the content of models.csv.
[[nodiscard]] std::string models_csv(const SurveyCorrection& result);

/// Returns the content of result.json.
/// @param settings  object with every option of the run, in the order to write.
[[nodiscard]] std::string result_json(const SurveyCorrection& result,
                                      const nlohmann::ordered_json& settings,
                                      const std::vector<text::InputFile>& inputs);

/// Returns these four files of a survey, stations.geojson and gsadjust.csv (export_files.hpp).
/// @param sites  must contain the sites of all stations.
[[nodiscard]] std::vector<text::NamedText> result_files(const SurveyCorrection& result,
                                                        const nlohmann::ordered_json& settings,
                                                        const std::vector<text::InputFile>& inputs,
                                                        const std::vector<text::Site>& sites);

}  // namespace a351::corrector
