#include "corrector/report/report.hpp"

#include <nlohmann/json.hpp>

#include "corrector/figure/drawing.hpp"
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
    const Page page(title);
    const pugi::xml_node body = page.body();
    const pugi::xml_node first = add_part(body, "section", "first");
    add(first, "h1", title);
    add_summary(first, result, warnings, report.warnings);
    add_stations(add_section(body, "Stations"), result);
    add_figures(add_section(body, "Figures"), of_results, drawing);
    add_closures(add_section(body, "Repeated stations"), result);
    add_occupations(add_section(body, "Readings"), result);
    add_models(add_section(body, "Models"), result);
    if (!of_records.empty()) add_figures(add_section(body, "Records"), of_records, drawing);
    add_provenance(add_section(body, "Settings, inputs, warnings"), settings, sources.inputs,
                   warnings);
    report.files.emplace_back("report.html", page.text());
    add_figure_files(report.files, all, drawing);
    return report;
}

}  // namespace a351::corrector::report
