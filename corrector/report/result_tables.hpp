#pragma once
/// @file
/// The tables of a report, as HTML.
///
/// Each function returns a piece of a page, for section() of html.hpp.  All texts are escaped.
/// "-" means that there is no value.  Text below a table explains its columns.  The values of
/// stations, readings and models are in result.json with all digits.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "protocol/text/input_file.hpp"

namespace a351::corrector::report {

/// Returns the values of the stations.  The text below the table says which kind of uncertainty u
/// is, because that depends on the model.
[[nodiscard]] std::string stations_html(const model::SurveyCorrection& result);

/// Returns the table of all readings with every correction, and an explanation of its columns.  The
/// columns are those of the model.  Occupations without a value have a row too.
///
/// Rows are in order of time.  With records the table has the first and the last averaged sample
/// and the averaged duration in s; for `day` it is the duration of the undisturbed samples
/// (reading_table_test.cpp).
/// @param result  at least one row; rows in ascending time, left_out sorted by start.
[[nodiscard]] std::string occupations_html(const model::SurveyCorrection& result);

/// Returns a table of the difference between readings of one station, before and after each
/// correction; a sentence if no station was read twice.  The last line has the root mean squares of
/// rms_of() in closure.hpp.
[[nodiscard]] std::string closures_html(const model::SurveyCorrection& result);

/// Returns the scores of all models, and the coefficients of the applied one.  With `auto` it also
/// gives the limit of the error by which a linear model was chosen.
[[nodiscard]] std::string models_html(const model::SurveyCorrection& result);

/// Returns warnings, settings, and inputs with their checksums.
/// @param settings  object; a value that is not a string is shown as JSON.  The key `warnings` is
///                  skipped, and the program with its version is added.
/// @param inputs    shown with role, name, size in bytes and CRC-32 in hexadecimal digits.
/// @param warnings  one item each; "None." if there are none.
[[nodiscard]] std::string provenance_html(const nlohmann::ordered_json& settings,
                                          const std::vector<text::InputFile>& inputs,
                                          const std::vector<std::string>& warnings);

}  // namespace a351::corrector::report
