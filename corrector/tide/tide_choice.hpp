#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/reading/survey_row.hpp"
#include "corrector/tide/earth_tide.hpp"

namespace a351::corrector {

/// Where the tide of a survey comes from.
struct TideChoice {
    /// given (of the table), direct = catalogue, longman, none; or the name of `series`.
    std::string source = "direct";
    TideFactors factors;           ///< Of direct and longman.
    std::filesystem::path series;  ///< CSV for TideSeries::read; empty: one of the names.
};

/// What may stand for a tide, for messages and help.
inline constexpr std::string_view kTideSources =
    "given, direct, catalogue, longman, none, or a CSV time,tide_mgal";

/// Sets the source from its name, or from a file's, relative to `directory`.
/// @return  whether `text` is either.
[[nodiscard]] bool set_tide_source(TideChoice& choice, const std::string& text,
                                   const std::filesystem::path& directory);

/// The same for an option.
/// @throws InputError  `text` is neither.
void set_tide_option(TideChoice& choice, const std::string& text);

/// The computed model behind a source other than `given` or a series.
/// @throws InputError  unknown source; names those allowed.
[[nodiscard]] TideModel tide_model(const std::string& source);

/// Sets the tide of each row at its time and site.
/// @throws InputError  a row's site is not in `sites`.
void set_tide(std::vector<SurveyRow>& rows, const std::vector<text::Site>& sites, TideModel model,
              TideFactors factors);

/// Takes the tide from the table read.
/// @throws InputError  a row has none.
void set_given_tide(std::vector<SurveyRow>& rows);

/// Sets the tide of every row.
/// @throws InputError  a row without a given tide, or one that the series does not cover.
void apply_tide(std::vector<SurveyRow>& rows, const std::vector<text::Site>& sites,
                const TideChoice& choice);

/// Adds source, model, factors (null where none apply) and sign to the settings of a result.
void describe_tide(nlohmann::ordered_json& settings, const TideChoice& choice);

}  // namespace a351::corrector
