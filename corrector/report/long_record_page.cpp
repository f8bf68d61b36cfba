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

constexpr const char* kTitle = "A long record at one point";

void add_text_table(pugi::xml_node parent, std::string_view alignment,
                    const long_record::TextTable& table) {
    add_table(parent, alignment, table.front(), {table.begin() + 1, table.end()});
}

void add_head(pugi::xml_node parent, const long_record::RecordResult& result) {
    const long_record::RecordSegment& segment = result.segment();
    const double hours = static_cast<double>(segment.size()) * result.record.step_s / 3600.0;
    const std::string& unit = segment.serial_number;
    add(parent, "h1", kTitle);
    add(parent, "p",
        fmt::format("Analysed: {}{} h from {}, a sample every {} s{}.",
                    unit.empty() ? "" : fmt::format("sensor {}, ", unit), text::fixed(hours, 1),
                    to_rfc3339(segment.start), text::fixed(result.record.step_s, 0),
                    result.record.is_tide_removed ? ", earth tide removed" : ""));
    add(parent, "p", result.analysis.reading);
    add(parent, "p", fmt::format("Two-path fit: {}.", long_record::two_paths_reading(result)));
    add_list(parent, result.analysis.remarks);
}

void add_applied(pugi::xml_node parent, const long_record::AppliedCalibration& applied,
                 const std::vector<figure::Figure>& figures, const figure::Drawing& drawing) {
    add_list(parent, long_record::applied_sentences(applied));
    add_text_table(parent, "lrrr", long_record::applied_bands_table(applied));
    add_figures(parent, figures, drawing);
    add_text_table(parent, "lrrr", long_record::allan_table(applied));
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

    const Page document(kTitle);
    const pugi::xml_node body = document.body();
    const pugi::xml_node first = add_part(body, "section", "first");
    add_head(first, result);
    add_list(first, page.warnings);
    if (result.applied)
        add_applied(add_section(body, "With the calibration"), *result.applied, applied, drawing);
    pugi::xml_node section = add_section(body, "Response by period");
    add_text_table(section, "lrrrrrr", long_record::response_table(result));
    add_figures(section, response, drawing);
    add_list(section, long_record::refused_bands(result));
    add_text_table(add_section(body, "Two paths"), "lrrll", long_record::two_paths_table(result));
    section = add_section(body, "The publication's statistics");
    add_text_table(section, "lrll", long_record::statistics_table(result));
    add(section, "p", long_record::chosen_modes(result));
    add_figures(add_section(body, "The publication's figures"), figures, drawing);
    section = add_section(body, "Segments");
    add_text_table(section, "llrrrl", long_record::segments_table(result));
    add(section, "p", "* analysed");
    add_list(section, long_record::refused_parts(result));
    add_provenance(add_section(body, "Settings, inputs, warnings"), settings, result.record.inputs,
                   result.record.warnings);
    page.files.emplace_back("record.html", document.text());
    add_figure_files(page.files, all, drawing);
    return page;
}

}  // namespace a351::corrector::report
