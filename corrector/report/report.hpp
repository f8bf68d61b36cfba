#pragma once
/// @file
/// The pages report.html of a survey and record.html of a long record, with their figures.
/// Content: corrector/methods.md, "Report".
///
/// Each page is one file with its pictures inside, well-formed XML without scripts, for screen and
/// A4.  Scripts and data of the figures are files in a folder beside it.
///
///     Report report = make_report(result, settings, sources);
///     text::write_together(folder, report.files);
///     for (const std::string& warning : report.warnings) std::cerr << warning << '\n';
///
/// The same input gives the same bytes with the same gnuplot (page_test.cpp).  Names and notes may
/// contain any bytes: they are escaped.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "corrector/archive_series/temperature_course.hpp"
#include "corrector/figure/drawing.hpp"
#include "corrector/long_record/record_result.hpp"
#include "corrector/model/corrected_survey.hpp"
#include "corrector/reading/representative_value.hpp"
#include "corrector/reading/signal_course.hpp"
#include "protocol/text/input_file.hpp"
#include "protocol/text/message.hpp"
#include "protocol/text/sites.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector::report {

/// Input of a report other than the corrected survey; parts without input are left out.
///
/// - `title`: name of the day; the heading is "Gravity survey TITLE".
/// - `sites`: positions of the stations, for the map.
/// - `inputs`: files that were read, with their checksums.
struct ReportSources {
    std::string title;
    std::vector<text::Site> sites;
    std::vector<reading::RepresentativeValue> records;  ///< Records of the rows.
    /// Temperature of the sensor.
    std::vector<archive_series::MinuteTemperature> temperature_course;
    std::vector<reading::SignalSpan> signal;  ///< Words of the recorder.
    /// Noise of an axis by the data sheet of the sensor; absent if its profile is not known.
    std::optional<double> data_sheet_mgal_per_sqrt_hz = {};
    std::vector<text::InputFile> inputs;
    /// Entries skipped or left out, with reasons; the report adds the remarks of the result.
    std::vector<text::Message> warnings;
    figure::FigureOptions figures;
};

/// The files of a report.  The page is the first of them.  `warnings` has one line at most, which
/// is on the page too.
struct Report {
    /// Contents of the page and of figures/NAME.gp, .dat, .svg and other formats if wanted.
    std::vector<text::NamedText> files;
    std::vector<std::string> warnings;  ///< Missing figures, with the reason.
};

/// Makes the report.
///
/// The order is: the answer with the problems of the day, a line per station and a map; the day in
/// one figure; readings with repeated stations and corrections; accuracy with uncertainties and
/// models; comparison with the references, records, and settings with inputs and warnings.
///
/// gnuplot draws the figures.  If it is missing or fails, the page has its text and says which
/// reason there is (page_test.cpp).
/// @param result    at least one row, as correct_survey() gives it.
/// @param settings  object with every option of the run.  Its key `warnings` is not shown.
/// @param sources   see ReportSources.
[[nodiscard]] Report make_report(const model::SurveyCorrection& result,
                                 const nlohmann::ordered_json& settings,
                                 const ReportSources& sources);

/// Makes record.html of a long record.
///
/// The order is: interpretation and two-path fit, applied calibration if there is one, response by
/// period, two paths, the publication's statistics and figures, segments, settings.  Of a tilt: its
/// effect of the temperature, its figure, segments, settings.  A missing
/// gnuplot has the same effect as in make_report().
/// @param result           analysed, with at least one stretch and one segment.
/// @param settings         object with every option of the run.
[[nodiscard]] Report make_long_record_page(const long_record::RecordResult& result,
                                           const nlohmann::ordered_json& settings,
                                           const figure::FigureOptions& options);

}  // namespace a351::corrector::report
