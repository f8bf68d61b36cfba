#pragma once
/// @file
/// The tables and the JSON of a corrected survey.  Two runs give the same bytes.
/// Columns and keys: table-format.md.
///
///     const auto files = result_files(result, settings, inputs, sites);
///     text::write_together(folder, files);
///
/// Numbers in CSV have six decimals, those in result.json all digits.  Use result.json for further
/// computations.  The functions return texts and write no file.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "protocol/text/input_file.hpp"
#include "protocol/text/sites.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector::result {

/// Returns the content of occupations.csv: rows and occupations without a value, in order of time.
/// An occupation without a value has its limits and its reason in `flags`; time_utc and all cells
/// after `flags` are empty.
/// @param result  at least one row; rows in order of time, left_out in order of start.
[[nodiscard]] std::string occupations_csv(const model::SurveyCorrection& result);
/// Returns the content of stations.csv: a line per station of the result, in its order.
[[nodiscard]] std::string stations_csv(const model::SurveyCorrection& result);
/// Returns the content of differences.csv: a line per pair of stations; only the header if the model
/// gives none.
[[nodiscard]] std::string differences_csv(const model::SurveyCorrection& result);

/// Returns the content of models.csv: a line per model and set of rows.  One line has `selected` 1,
/// that of the applied model on the rows of its fit.
[[nodiscard]] std::string models_csv(const model::SurveyCorrection& result);

/// Returns the content of result.json: UTF-8, indented by two blanks, with a line end.
///
/// Numbers that are not finite become null.  Bytes of a name that are not UTF-8 become U+FFFD.
/// There is no time of the run in it, so that a repetition can be compared byte by byte.
/// @param settings  object with every option of the run, in the order to write.
/// @param inputs    files that were read; of their paths only the names are written.
[[nodiscard]] std::string result_json(const model::SurveyCorrection& result,
                                      const nlohmann::ordered_json& settings,
                                      const std::vector<text::InputFile>& inputs);

/// Returns `coefficients` of result.json: name, value and standard error of each.
[[nodiscard]] nlohmann::ordered_json coefficients_json(
    const std::vector<model::Coefficient>& coefficients);

/// Returns `station_covariance` of result.json; null without one.
[[nodiscard]] nlohmann::ordered_json covariance_json(
    const std::optional<model::StationCovariance>& covariance);

/// Returns these files of a survey, and those for other programs (export_files.hpp).
/// @param result    as occupations_csv().
/// @param settings  as result_json().
/// @param inputs    as result_json().
/// @param sites     sites of the stations, for the files for other programs.  A station that is absent
///                  here is missing in them.
[[nodiscard]] std::vector<text::NamedText> result_files(const model::SurveyCorrection& result,
                                                        const nlohmann::ordered_json& settings,
                                                        const std::vector<text::InputFile>& inputs,
                                                        const std::vector<text::Site>& sites);

}  // namespace a351::corrector::result
