#pragma once
/// @file
/// The pages report.html of a survey and record.html of a long record, with their figures.
/// Content: corrector/methods.md, "Report".

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "corrector/long_record/record_result.hpp"
#include "corrector/model/survey_correction.hpp"
#include "corrector/reading/representative_value.hpp"
#include "corrector/reading/temperature_course.hpp"
#include "protocol/text/input_file.hpp"
#include "protocol/text/sites.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector {

/// Input of a report other than the corrected survey; parts without input are left out.
struct ReportSources {
    std::string title;
    std::vector<text::Site> sites;
    std::vector<RepresentativeValue> records;           ///< Records of the rows.
    std::vector<MinuteTemperature> temperature_course;  ///< Temperature of the sensor.
    std::vector<text::InputFile> inputs;
    /// Entries skipped or left out, with reasons; the report adds the remarks of the result.
    std::vector<std::string> warnings;
    std::vector<std::string> picture_formats;  ///< Formats other than SVG, from picture_formats().
};

/// The files of a report.
struct Report {
    /// Contents of the page and of figures/NAME.gp, .dat, .svg and other formats if wanted.
    std::vector<text::NamedText> files;
    std::vector<std::string> warnings;  ///< Missing figures, with the reason.
};

/// Makes the report.
/// @param settings  object with every option of the run.
[[nodiscard]] Report make_report(const SurveyCorrection& result,
                                 const nlohmann::ordered_json& settings,
                                 const ReportSources& sources);

/// Makes record.html of a long record.
/// @param settings         object with every option of the run.
/// @param picture_formats  formats other than SVG, from picture_formats().
[[nodiscard]] Report make_long_record_page(const RecordResult& result,
                                           const nlohmann::ordered_json& settings,
                                           const std::vector<std::string>& picture_formats);

}  // namespace a351::corrector
