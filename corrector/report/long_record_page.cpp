#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "corrector/figure/long_record_figures.hpp"
#include "corrector/long_record/applied_tables.hpp"
#include "corrector/report/html.hpp"
#include "corrector/report/report.hpp"
#include "corrector/report/result_tables.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::report {
namespace {

void add_text_table(pugi::xml_node parent, const std::string& caption, std::string_view alignment,
                    const long_record::TextTable& table) {
    add_table(parent, caption, alignment, table.front(), {table.begin() + 1, table.end()});
}

void add_record_head(pugi::xml_node parent, const long_record::RecordResult& result) {
    const long_record::RecordSegment& segment = result.segment();
    const double hours = segment.hours(result.record.step_s);
    const std::string& unit = segment.serial_number;
    add(parent, "p",
        text::tr("Analysed: {}{} h from {}, a sample every {} s{}.",
                 unit.empty() ? "" : text::tr("sensor {}, ", unit), text::fixed(hours, 1),
                 to_rfc3339(segment.start), text::fixed(result.record.step_s, 0),
                 result.record.is_tide_removed ? text::tr(", earth tide removed") : ""));
    add(parent, "p", text::in_words(result.analysis.reading));
    add(parent, "p",
        text::tr("Two-path fit: {}.", text::Message(long_record::two_paths_reading(result))));
    add_list(parent, text::each_in_words(result.analysis.remarks));
}

void add_applied(pugi::xml_node parent, const long_record::AppliedCalibration& applied,
                 const std::vector<figure::Figure>& figures, const figure::Drawing& drawing) {
    add_list(parent, long_record::applied_sentences(applied));
    add_text_table(parent,
                   text::tr("Scatter of the record by period, rms in mGal, before and after."),
                   "lrrr", long_record::applied_bands_table(applied));
    add_figures(parent, figures, drawing);
    add_text_table(parent,
                   text::tr("Allan deviation of the record by averaging time, before and after."),
                   "lrrr", long_record::allan_table(applied));
}

void add_segments(Page& document, const long_record::RecordResult& result,
                  const nlohmann::ordered_json& settings) {
    pugi::xml_node section = document.add_section(text::tr("Segments"));
    add_text_table(section,
                   result.tilt ? text::tr("Parts of the record without gaps.")
                               : text::tr("Parts of the record without gaps; * analysed."),
                   "llrrrl", long_record::segments_table(result));
    add_list(section, long_record::refused_parts(result.parts));
    add_provenance(document.add_section(text::tr("Settings, inputs, warnings")), settings,
                   result.record.inputs, text::tr("Warnings"),
                   text::each_in_words(result.record.warnings));
}

Report make_tilt_page(const long_record::RecordResult& result,
                      const nlohmann::ordered_json& settings,
                      const figure::FigureOptions& options) {
    const std::vector<figure::Figure> figures{figure::tilt_figure(result, options.print)};
    figure::Drawing drawing = figure::draw(figures, options.formats);
    Report page;
    page.warnings = missing_lines(drawing.troubles);
    Page document(text::tr("Tilt at one point"));
    add(document.body(), "p", long_record::tilt_reading(result));
    add_list(document.body(), page.warnings);
    add_figures(document.body(), figures, drawing);
    add_segments(document, result, settings);
    page.files.emplace_back("record.html", document.text());
    add_figure_files(page.files, figures, drawing);
    return page;
}

}  // namespace

Report make_long_record_page(const long_record::RecordResult& result,
                             const nlohmann::ordered_json& settings,
                             const figure::FigureOptions& options) {
    if (result.tilt) return make_tilt_page(result, settings, options);
    std::vector<figure::Figure> figures = figure::long_record_figures(result, options.print);
    const std::vector<figure::Figure> response{figure::response_figure(result, options.print)};
    std::vector<figure::Figure> all = figures;
    all.push_back(response.front());
    const std::vector<figure::Figure> noise = figure::noise_figures(result, options.print);
    all.insert(all.end(), noise.begin(), noise.end());
    const std::vector<figure::Figure> applied = result.applied
                                                    ? figure::applied_figures(result, options.print)
                                                    : std::vector<figure::Figure>();
    all.insert(all.end(), applied.begin(), applied.end());
    figure::Drawing drawing = figure::draw(all, options.formats);
    Report page;
    page.warnings = missing_lines(drawing.troubles);

    Page document(text::tr("A long record at one point"));
    add_record_head(document.body(), result);
    add_list(document.body(), page.warnings);
    if (result.applied)
        add_applied(document.add_section(text::tr("With the calibration")), *result.applied,
                    applied, drawing);
    pugi::xml_node section = document.add_section(text::tr("Response by period"));
    add_text_table(
        section,
        text::tr("Response of the acceleration to the temperature by period, with limits of 95 %."),
        "lrrrrrr", long_record::response_table(result));
    add_figures(section, response, drawing);
    add_list(section, long_record::refused_bands(result));
    add_text_table(
        document.add_section(text::tr("Two paths")),
        text::tr("Parameters of the two paths with their standard errors, from the fit (in "
                 "sample)."),
        "lrrll", long_record::two_paths_table(result));
    section = document.add_section(text::tr("Noise, and how long to stay"));
    add(section, "p", fmt::format("{}.", long_record::noise_reading(result)));
    add_figures(section, noise, drawing);
    add_text_table(section, text::tr("Allan deviation of the record by averaging time."), "rrrr",
                   long_record::noise_table(result));
    section = document.add_section(text::tr("The publication's statistics"));
    add_text_table(section, text::tr("Statistics of this record beside the published ones."),
                   "lrll", long_record::statistics_table(result));
    add(section, "p", long_record::chosen_modes(result));
    add_figures(document.add_section(text::tr("The publication's figures")), figures, drawing);
    add_segments(document, result, settings);
    page.files.emplace_back("record.html", document.text());
    add_figure_files(page.files, all, drawing);
    return page;
}

}  // namespace a351::corrector::report
