#include "corrector/report/report.hpp"

#include <nlohmann/json.hpp>

#include "corrector/figure/drawing.hpp"
#include "corrector/figure/escaping.hpp"
#include "corrector/figure/map_figure.hpp"
#include "corrector/figure/record_figures.hpp"
#include "corrector/figure/table_figures.hpp"
#include "corrector/figure/temperature_figure.hpp"
#include "corrector/report/html.hpp"
#include "corrector/report/page_parts.hpp"
#include "corrector/report/reading_table.hpp"
#include "corrector/report/result_tables.hpp"
#include "corrector/report/summary.hpp"

namespace a351::corrector {
namespace {

/// The figures of the two sections of the report.
struct Figures {
    std::vector<Figure> results;
    std::vector<Figure> records;

    [[nodiscard]] std::vector<Figure> all() const {
        std::vector<Figure> figures = results;
        figures.insert(figures.end(), records.begin(), records.end());
        return figures;
    }
};

Figures make_figures(const SurveyCorrection& result, const ReportSources& sources) {
    Figures figures;
    const auto add = [&figures](std::optional<Figure> figure) {
        if (figure) figures.results.push_back(std::move(*figure));
    };
    add(corrected_figure(result));
    add(residual_figure(result));
    add(difference_figure(result));
    add(acceleration_figure(result));
    add(map_figure(result, sources.sites));
    add(temperature_figure(result, sources.temperature_course));
    const std::vector<ReadingRecord> records = find_records(result, sources.records);
    figures.records = panel_figures(result, records);
    for (Figure& figure : reading_figures(result, records)) {
        figures.records.push_back(std::move(figure));
    }
    return figures;
}

}  // namespace

Report make_report(const SurveyCorrection& result, const nlohmann::ordered_json& settings,
                   const ReportSources& sources) {
    const Figures figures = make_figures(result, sources);
    Drawing drawing = draw(figures.all(), sources.picture_formats);
    Report report;
    report.warnings = missing_lines(drawing.troubles);

    const std::string title = "Gravity survey " + sources.title;
    std::string body = "<section class=\"first\">\n<h1>" + html_text(title) + "</h1>\n" +
                       summary_html(result, sources.warnings, report.warnings) + "</section>\n";
    body += section("Stations", stations_html(result));
    body += section("Figures", figures_html(figures.results, drawing));
    body += section("Repeated stations", closures_html(result));
    body += section("Readings", occupations_html(result));
    body += section("Models", models_html(result));
    if (!figures.records.empty()) {
        body += section("Records", figures_html(figures.records, drawing));
    }
    body += section("Settings, inputs, warnings",
                    provenance_html(settings, sources.inputs, sources.warnings));
    report.files.emplace_back("report.html", html_page(title, body));
    add_figure_files(report.files, figures.all(), drawing);
    return report;
}

}  // namespace a351::corrector
