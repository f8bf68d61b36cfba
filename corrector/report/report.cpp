#include "corrector/report/report.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "corrector/figure/drawing.hpp"
#include "corrector/figure/escaping.hpp"
#include "corrector/figure/survey_figures.hpp"
#include "corrector/report/html.hpp"
#include "corrector/report/result_tables.hpp"
#include "corrector/report/summary.hpp"

namespace a351::corrector::report {
namespace {

/// Returns the figures of the results, not of the records.
std::vector<figure::Figure> result_figures(const model::SurveyCorrection& result,
                                           const ReportSources& sources) {
    std::vector<figure::Figure> figures;
    for (auto& figure :
         {figure::corrected_figure(result), figure::residual_figure(result),
          figure::difference_figure(result), figure::acceleration_figure(result),
          figure::map_figure(result, sources.sites),
          std::optional(figure::temperature_figure(result, sources.temperature_course))}) {
        if (figure) figures.push_back(*figure);
    }
    return figures;
}

std::vector<figure::Figure> record_figures(const model::SurveyCorrection& result,
                                           const ReportSources& sources) {
    const std::vector<figure::ReadingRecord> records =
        figure::find_records(result, sources.records);
    std::vector<figure::Figure> figures = figure::panel_figures(result, records);
    for (figure::Figure& figure : figure::reading_figures(result, records))
        figures.push_back(std::move(figure));
    return figures;
}

}  // namespace

Report make_report(const model::SurveyCorrection& result, const nlohmann::ordered_json& settings,
                   const ReportSources& sources) {
    const std::vector<figure::Figure> of_results = result_figures(result, sources);
    const std::vector<figure::Figure> of_records = record_figures(result, sources);
    std::vector<figure::Figure> all = of_results;
    all.insert(all.end(), of_records.begin(), of_records.end());
    figure::Drawing drawing = figure::draw(all, sources.picture_formats);
    Report report;
    report.warnings = missing_lines(drawing.troubles);

    std::vector<std::string> warnings = sources.warnings;
    warnings.insert(warnings.end(), result.remarks.begin(), result.remarks.end());
    const std::string title = "Gravity survey " + sources.title;
    std::string body =
        fmt::format("<section class=\"first\">\n<h1>{}</h1>\n{}</section>\n",
                    figure::html_text(title), summary_html(result, warnings, report.warnings));
    body += section("Stations", stations_html(result));
    body += section("Figures", figures_html(of_results, drawing));
    body += section("Repeated stations", closures_html(result));
    body += section("Readings", occupations_html(result));
    body += section("Models", models_html(result));
    if (!of_records.empty()) body += section("Records", figures_html(of_records, drawing));
    body +=
        section("Settings, inputs, warnings", provenance_html(settings, sources.inputs, warnings));
    report.files.emplace_back("report.html", html_page(title, body));
    add_figure_files(report.files, all, drawing);
    return report;
}

}  // namespace a351::corrector::report
