#pragma once
/// @file
/// The tables and the JSON of a corrected survey.  Run twice, the bytes are the same.
/// Columns and keys: table-format.md.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "corrector/model/survey_correction.hpp"
#include "protocol/text/input_file.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector {

[[nodiscard]] std::string occupations_csv(const SurveyCorrection& result);
[[nodiscard]] std::string stations_csv(const SurveyCorrection& result);
[[nodiscard]] std::string models_csv(const SurveyCorrection& result);

/// @param settings  object with every option of the run, in the order to be written.
[[nodiscard]] std::string result_json(const SurveyCorrection& result,
                                      const nlohmann::ordered_json& settings,
                                      const std::vector<text::InputFile>& inputs);

/// The four files of a survey.
[[nodiscard]] std::vector<text::NamedText> result_files(const SurveyCorrection& result,
                                                        const nlohmann::ordered_json& settings,
                                                        const std::vector<text::InputFile>& inputs);

}  // namespace a351::corrector
