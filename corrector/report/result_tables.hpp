#pragma once
/// @file
/// The tables of a report.
///
/// Each function adds its tables to a section of a page (html.hpp).
/// "-" means that there is no value.  The caption of a table explains its columns and says which
/// kind of error they have.  The values of
/// stations, readings and models are in result.json with all digits.

#include <nlohmann/json_fwd.hpp>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "protocol/text/input_file.hpp"

namespace a351::corrector::report {

/// Adds the values of the stations.  The caption says which kind of uncertainty u is, because that
/// depends on the model.
void add_stations(pugi::xml_node parent, const model::SurveyCorrection& result);

/// Adds the sources of the stations' uncertainties; nothing unless `day` is applied.
void add_budget(pugi::xml_node parent, const model::SurveyCorrection& result);

/// Adds Table 2 of the publication; nothing for another model than `paper`.
void add_paper_table(pugi::xml_node parent, const model::SurveyCorrection& result);
/// Adds the comparison with reference gravimeters.
/// @param result  with `side_by_side`.
void add_side_by_side(pugi::xml_node parent, const model::SurveyCorrection& result);

/// Adds the table of all readings with their errors and grades.  The columns are those of the model.
/// Occupations without a value have a row too.
///
/// Rows are in order of time.  With records the table has the first and the last averaged sample
/// and the averaged duration in s; for `day` it is the duration of the undisturbed samples
/// (reading_table_test.cpp).
/// @param result  at least one row; rows in ascending time, left_out sorted by start.
void add_readings(pugi::xml_node parent, const model::SurveyCorrection& result);

/// Adds the table of all corrections of the readings.
///
/// The temperature correction contains the constant of the model, hundreds or thousands of mGal.
/// The table therefore shows it about its mean, which the caption gives.
void add_corrections(pugi::xml_node parent, const model::SurveyCorrection& result);

/// Adds a table of the difference between readings of one station, before and after each
/// correction; a sentence if no station was read twice.  The last line has the root mean squares of
/// rms_of() in closure.hpp.
void add_closures(pugi::xml_node parent, const model::SurveyCorrection& result);

/// Adds the scores of all models, and the coefficients of the applied one.  With `auto` it also
/// gives the limit of the error by which a linear model was chosen.
void add_models(pugi::xml_node parent, const model::SurveyCorrection& result);

/// Adds warnings below their title, settings, and inputs with their checksums.
/// @param settings  object; a value that is not a string is shown as JSON.  The key `warnings` is
///                  skipped, and the program with its version is added.
/// @param inputs    shown with role, name, size in bytes and CRC-32 in hexadecimal digits.
/// @param warnings  one item each; "None." if there are none.
void add_provenance(pugi::xml_node parent, const nlohmann::ordered_json& settings,
                    const std::vector<text::InputFile>& inputs, const std::string& title,
                    const std::vector<std::string>& warnings);

}  // namespace a351::corrector::report
