#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "corrector/model/survey_correction.hpp"
#include "corrector/reading/decimated_axes.hpp"
#include "corrector/reading/trend_curve.hpp"
#include "corrector/tide/tide_choice.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector {

/// One survey day as written in its TOML file, table [survey].  Paths are relative to that file.
struct SurveyFile {
    std::filesystem::path path;         ///< Empty: there is none.
    std::string name;                   ///< Of the day; default: the file's stem.
    std::filesystem::path root;         ///< Data root: archive/, metadata/, events/.
    std::filesystem::path sites;        ///< CSV of the benchmarks.
    std::filesystem::path occupations;  ///< CSV; empty: the event log of the root.
    std::filesystem::path amendments;   ///< TOML for amend(); empty: none.
    std::filesystem::path calibration;  ///< What survey.calibration was read from; empty: none.
    std::optional<UtcTime> from;        ///< Occupations that start from here on ...
    std::optional<UtcTime> to;          ///< ... and before this; neither: a log's last day.
    SurveyOptions survey;
    TideChoice tide;
    std::optional<TrendCurve>
        curve;  ///< Absent: RepresentativeOptions' default.  `paper` has its own.
    TrendMethod trend = TrendMethod::eemd;
    double cutoff_s = 300.0;  ///< Of the smoother's trend.
    NormOrder norm = NormOrder::decimate_first;
    std::uint64_t seed = 1;  ///< Of the noise of the decomposition.
};

/// @throws InputError  unknown key or value, a root that is no directory, a base or datum that is
///                     not in the table of sites.
[[nodiscard]] SurveyFile read_survey_file(const std::filesystem::path& file);

/// Reads a calibration for the survey.
void use_calibration(SurveyFile& survey, const std::filesystem::path& file);

/// The trend that applies: the publication's decomposition for model `paper`, else as asked for.
[[nodiscard]] TrendMethod trend_method_of(const SurveyFile& survey) noexcept;

/// The curve that applies: the publication's for model `paper`, else as asked for or by default.
[[nodiscard]] TrendCurve trend_curve_of(const SurveyFile& survey);

}  // namespace a351::corrector
