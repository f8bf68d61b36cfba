#pragma once
/// @file
/// report.html of a survey, with its figures.  Content: corrector/methods.md, "Report".

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "corrector/model/survey_correction.hpp"
#include "corrector/reading/representative_value.hpp"
#include "corrector/reading/temperature_course.hpp"
#include "protocol/text/input_file.hpp"
#include "protocol/text/sites.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector {

/// What a report is made of beside the corrected survey; what is empty is left out of it.
struct ReportSources {
    std::string title;
    std::vector<text::Site> sites;
    std::vector<RepresentativeValue> records;           ///< Behind the rows.
    std::vector<MinuteTemperature> temperature_course;  ///< Of the sensor.
    std::vector<text::InputFile> inputs;
    std::vector<std::string> warnings;         ///< What was passed over, and why.
    std::vector<std::string> picture_formats;  ///< Besides SVG, of picture_formats().
};

struct Report {
    /// report.html and figures/NAME.gp, .dat, .svg (and as asked for).
    std::vector<text::NamedText> files;
    std::vector<std::string> warnings;  ///< Figures that are missing, and why.
};

/// @param settings  object with every option of the run.
[[nodiscard]] Report make_report(const SurveyCorrection& result,
                                 const nlohmann::ordered_json& settings,
                                 const ReportSources& sources);

}  // namespace a351::corrector
