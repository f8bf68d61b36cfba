#pragma once
/// @file
/// The survey file: data and options of one survey day.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "corrector/model/survey_correction.hpp"
#include "corrector/reading/occupation_rows.hpp"
#include "corrector/tide/tide_choice.hpp"

namespace a351::corrector {

/// One survey day, from table [survey] of its TOML file.  Paths in the file are relative to it.
/// The options of the average are those below; read_survey() sets `averaging` from them.
struct SurveyFile : SurveySource {
    std::string name;                   ///< Name of the day; default: the file's stem.
    std::filesystem::path calibration;  ///< File of survey.calibration; empty: none.
    SurveyOptions survey;
    TideChoice tide;
    std::optional<TrendCurve>
        curve;  ///< Absent: the default of RepresentativeOptions, or of `paper`.
    TrendMethod trend = TrendMethod::eemd;
    double cutoff_s = 300.0;  ///< Cut-off period of the smoother's trend, s.
    NormOrder norm = NormOrder::decimate_first;
    std::uint64_t seed = 1;  ///< Seed of the decomposition's noise.
};

/// Reads a survey file.
/// @throws InputError  unknown key or value, a root that is no directory, a base or datum that is
///                     not in the table of sites.
[[nodiscard]] SurveyFile read_survey_file(const std::filesystem::path& file);

/// Reads a calibration for the survey.
void use_calibration(SurveyFile& survey, const std::filesystem::path& file);

/// Returns the trend that is used: the publication's decomposition for model `paper`, else that of
/// the file.
[[nodiscard]] TrendMethod trend_method_of(const SurveyFile& survey) noexcept;

/// Returns the trend curve that is used: the publication's for model `paper`, else that of the file
/// or the default.
[[nodiscard]] TrendCurve trend_curve_of(const SurveyFile& survey);

}  // namespace a351::corrector
