#pragma once
/// @file
/// The survey file: data and options of one survey day.
///
///     SurveyFile survey = read_survey_file("day.toml");
///     OccupationRows read = read_survey(survey, progress);  // survey_readings.hpp
///
/// The smallest file is `[survey]`: the data root is then `data` beside it, and the table of sites
/// is `sites.csv` beside it.  Its keys are in the manual page a351-survey.toml(5).  Options of the
/// command line are set in the struct after reading; the file itself is never changed.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "corrector/model/corrected_survey.hpp"
#include "corrector/reading/occupation_rows.hpp"
#include "corrector/reduction/row_reduction.hpp"
#include "corrector/tide/tide_choice.hpp"

namespace a351::corrector::job {

/// Readings of reference gravimeters at the stations of a survey, from table [reference].
struct ReferenceSurvey {
    std::filesystem::path observations;  ///< Table as `a351-correct import` writes it.
    adjustment::Priors priors;           ///< Standard deviation of a reading, and the scale.
    model::NetworkOptions network;       ///< Drift of each loop.
};

/// One survey day, from table [survey] of its TOML file.  Paths in the file are relative to it.
///
/// - `survey`: options of the correction, with the priors of table [prior].  `calibration` and
///   `survey.calibration` belong together; use_calibration() sets both.
/// - `tide`: source of the tide; a file is relative to the survey file.
/// - `reduction`: heights and air pressure of the readings.
/// - `averaging`: as written in the file.  What is used depends on the model too: see averaging_of().
/// - `survey.seed`: of the decomposition and of the bootstrap.  The same seed gives the same result.
///
/// A default-constructed object has the defaults of the file, but no paths.
struct SurveyFile : reading::SurveySource {
    std::string name;                   ///< Name of the day; default: the file's stem.
    std::filesystem::path calibration;  ///< File of survey.calibration; empty: none.
    std::string unused_calibration;     ///< Unit of a calibration that by_unit() left out.
    model::SurveyOptions survey;
    tide::Choice tide;
    reduction::ReductionChoice reduction;
    std::optional<double> bouguer_density_kg_per_m3;  ///< Absent: no anomalies.
    std::optional<ReferenceSurvey> reference;
};

/// Reads a survey file.
///
/// The table of sites and the calibration are read and checked too.  Occupations, amendments and
/// samples are not: read_survey() does this.  A message has file, line, key and value, and what is
/// allowed; examples are in survey_file_test.cpp.
/// @param file  TOML with table [survey] and, if wanted, tables [prior] and [reference].
/// @throws InputError  unknown key or value, a root that is no directory, a base or datum that is
///                     not in the table of sites.  Also a file, a table of sites or a calibration
///                     that cannot be read.
[[nodiscard]] SurveyFile read_survey_file(const std::filesystem::path& file);

/// Returns the survey of a data root without a survey file: all its keys have their defaults.
/// @param root   its folder is the name of the survey.
/// @param sites  table of the sites; empty: sites.csv beside the root.
/// @throws InputError  the table of sites cannot be read.
[[nodiscard]] SurveyFile survey_of_root(const std::filesystem::path& root,
                                        const std::filesystem::path& sites);

/// Reads a calibration for the survey.  It replaces an earlier one.
///
/// The unit and the validity are compared with the record later, by check_calibration().
/// @throws InputError  as read_calibration(); the survey has then the new path and its old numbers.
void use_calibration(SurveyFile& survey, const std::filesystem::path& file);

/// Adds the options of the correction to the settings of result.json, from `model` to `datum`.
/// @param base  of the corrected survey.
void describe_correction(nlohmann::ordered_json& settings, const SurveyFile& survey,
                         const std::string& base);

/// Returns the options of the averages that are used: for model `paper` the publication's
/// decomposition and its curve, else those of the file with the slow curve.  Use it instead of
/// SurveyFile::averaging in every output.
///
/// The cut-off has an effect with any trend, because the other trend is computed for comparison; so
/// has the curve with the smoother, on eemd_mgal.
[[nodiscard]] reading::RepresentativeOptions averaging_of(const SurveyFile& survey);

}  // namespace a351::corrector::job
