#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "corrector/figure/long_record_figures.hpp"
#include "corrector/long_record/applied_tables.hpp"
#include "corrector/report/html.hpp"
#include "corrector/report/report.hpp"
#include "corrector/report/result_tables.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::report {
namespace {

std::string table_html(std::string_view alignment, const long_record::TextTable& table) {
    return html_table(alignment, table.front(), {table.begin() + 1, table.end()});
}

std::string head_html(const long_record::RecordResult& result) {
    const long_record::RecordSegment& segment = result.segment();
    const double hours = static_cast<double>(segment.size()) * result.record.step_s / 3600.0;
    const std::string& unit = segment.serial_number;
    return "<h1>A long record at one point</h1>\n" +
           html_paragraph(fmt::format(
               "Analysed: {}{} h from {}, a sample every {} s{}.",
               unit.empty() ? "" : fmt::format("sensor {}, ", unit), text::fixed(hours, 1),
               to_rfc3339(segment.start), text::fixed(result.record.step_s, 0),
               result.record.is_tide_removed ? ", earth tide removed" : "")) +
           html_paragraph(result.analysis.reading) +
           html_paragraph(
               fmt::format("Two-path fit: {}.", long_record::two_paths_reading(result))) +
           html_list(result.analysis.remarks);
}

}  // namespace

Report make_long_record_page(const long_record::RecordResult& result,
                             const nlohmann::ordered_json& settings,
                             const std::vector<std::string>& picture_formats) {
    std::vector<figure::Figure> figures = figure::long_record_figures(result);
    const std::vector<figure::Figure> response{figure::response_figure(result)};
    std::vector<figure::Figure> all = figures;
    all.push_back(response.front());
    const std::vector<figure::Figure> applied =
        result.applied ? figure::applied_figures(result) : std::vector<figure::Figure>();
    all.insert(all.end(), applied.begin(), applied.end());
    figure::Drawing drawing = figure::draw(all, picture_formats);
    Report page;
    page.warnings = missing_lines(drawing.troubles);

    std::string body = "<section class=\"first\">\n" + head_html(result) +
                       html_list(page.warnings) + "</section>\n";
    if (result.applied)
        body += section("With the calibration",
                        html_list(long_record::applied_sentences(*result.applied)) +
                            table_html("lrrr", long_record::applied_bands_table(*result.applied)) +
                            figures_html(applied, drawing) +
                            table_html("lrrr", long_record::allan_table(*result.applied)));
    body +=
        section("Response by period", table_html("lrrrrrr", long_record::response_table(result)) +
                                          figures_html(response, drawing) +
                                          html_list(long_record::refused_bands(result)));
    body += section("Two paths", table_html("lrrll", long_record::two_paths_table(result)));
    body += section("The publication's statistics",
                    table_html("lrll", long_record::statistics_table(result)) +
                        html_paragraph(long_record::chosen_modes(result)));
    body += section("The publication's figures", figures_html(figures, drawing));
    body += section("Segments", table_html("llrrrl", long_record::segments_table(result)) +
                                    html_paragraph("* analysed") +
                                    html_list(long_record::refused_parts(result)));
    body += section("Settings, inputs, warnings",
                    provenance_html(settings, result.record.inputs, result.record.warnings));
    page.files.emplace_back("record.html", html_page("A long record at one point", body));
    add_figure_files(page.files, all, drawing);
    return page;
}

}  // namespace a351::corrector::report
