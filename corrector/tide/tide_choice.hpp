#pragma once
/// @file
/// Choice of the tide of a survey, and its application to the rows.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/reading/survey_row.hpp"
#include "corrector/tide/earth_tide.hpp"

namespace a351::corrector {

/// The source of a survey's tide.
struct TideChoice {
    /// Name: given (column of the table), direct = catalogue, longman, none; or the file name of
    /// `series`.
    std::string source = "direct";
    TideFactors factors;  ///< Factors of direct and longman.
    std::filesystem::path
        series;  ///< CSV for TideSeries::read(); empty: `source` is one of the names.
};

/// Allowed values of a tide, for messages and help.
inline constexpr std::string_view kTideSources =
    "given, direct, catalogue, longman, none, or a CSV time,tide_mgal";

/// Sets the source from its name, or from a file name relative to `directory`.
/// @return false, and nothing is changed, if `text` is neither a name nor a regular file.
[[nodiscard]] bool set_tide_source(TideChoice& choice, const std::string& text,
                                   const std::filesystem::path& directory);

/// Sets the source from the text of the option --tide; files are relative to the current directory.
/// @throws InputError  if `text` is neither a name nor a regular file.
void set_tide_option(TideChoice& choice, const std::string& text);

/// Returns the model of a computed source: direct, catalogue, longman or none.
/// @throws InputError  if the source is another one; names those allowed.
[[nodiscard]] TideModel tide_model(const std::string& source);

/// Sets the tide of every row from the chosen source.
/// @throws InputError  as tide_model() or TideSeries::read(); if a row's site is not in `sites`, a
///                     row has no given tide, or the series does not cover a row.
void apply_tide(std::vector<SurveyRow>& rows, const std::vector<text::Site>& sites,
                const TideChoice& choice);

/// Adds source, model, sign and factors of the tide to the settings of a result.  The factors are
/// null if the tide is not computed.
void describe_tide(nlohmann::ordered_json& settings, const TideChoice& choice);

}  // namespace a351::corrector
