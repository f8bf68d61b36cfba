#include "corrector/report/report.hpp"

#include <nlohmann/json.hpp>

#include "corrector/figure/survey_figures.hpp"
#include "corrector/report/html.hpp"
#include "corrector/report/result_tables.hpp"
#include "corrector/report/summary.hpp"

namespace a351::corrector::report {
namespace {

using text::tr;

/// The figures of a survey by their places in the page.
struct SurveyFigures {
    std::vector<figure::Figure> day, map, side_by_side, publication, records;

    [[nodiscard]] std::vector<figure::Figure> all() const {
        std::vector<figure::Figure> figures;
        for (const auto* const part : {&day, &map, &side_by_side, &publication, &records})
            figures.insert(figures.end(), part->begin(), part->end());
        return figures;
    }
};

SurveyFigures figures_of(const model::SurveyCorrection& result, const ReportSources& sources) {
    const figure::Print& print = sources.figures.print;
    const std::vector<figure::ReadingRecord> records =
        figure::find_records(result, sources.records);
    SurveyFigures figures;
    figures.day = {
        figure::day_figure(result, records, sources.temperature_course, sources.signal, print)};
    if (const auto faces = figure::faces_figure(result, print)) figures.day.push_back(*faces);
    if (const auto map = figure::map_figure(result, sources.sites, print)) figures.map = {*map};
    if (const auto figure = figure::side_by_side_figure(result, print))
        figures.side_by_side = {*figure};
    for (const auto& figure :
         {figure::difference_figure(result, print), figure::acceleration_figure(result, print),
          figure::corrected_figure(result, print)})
        if (figure) figures.publication.push_back(*figure);
    figures.records = figure::panel_figures(result, records, print);
    for (figure::Figure& figure :
         figure::quiet_noise_figures(result, records, sources.data_sheet_mgal_per_sqrt_hz, print))
        figures.records.push_back(std::move(figure));
    for (figure::Figure& figure : figure::reading_figures(result, records, print))
        figures.records.push_back(std::move(figure));
    return figures;
}

}  // namespace

Report make_report(const model::SurveyCorrection& result, const nlohmann::ordered_json& settings,
                   const ReportSources& sources) {
    const SurveyFigures figures = figures_of(result, sources);
    const std::vector<figure::Figure> all = figures.all();
    figure::Drawing drawing = figure::draw(all, sources.figures.formats);
    Report report;
    report.warnings = missing_lines(drawing.troubles);
    std::vector<std::string> warnings = text::each_in_words(sources.warnings);
    for (const text::Message& remark : result.remarks) warnings.push_back(text::in_words(remark));

    Page page(tr("Gravity survey {}", sources.title));
    add_answer(page.body(), result, report.warnings);
    const pugi::xml_node first = add_part(page.body(), "div", "first");
    add_answer_table(first, result);
    add_figures(first, figures.map, drawing);
    add_notes(page.body(), result, warnings.size());
    add_figures(page.add_section(tr("The day")), figures.day, drawing);
    const pugi::xml_node readings = page.add_section(tr("Readings"));
    add_readings(readings, result);
    add_closures(readings, result);
    add_corrections(readings, result);
    add_paper_table(readings, result);
    const pugi::xml_node accuracy = page.add_section(tr("Accuracy"));
    add_accuracy(accuracy, result);
    add_stations(accuracy, result);
    add_budget(accuracy, result);
    add_models(accuracy, result);
    if (result.side_by_side) {
        const pugi::xml_node section = page.add_section(tr("Side by side"));
        add_side_by_side(section, result);
        add_figures(section, figures.side_by_side, drawing);
    }
    if (!figures.publication.empty())
        add_figures(page.add_section(tr("Comparison with the references")), figures.publication,
                    drawing);
    if (!figures.records.empty())
        add_figures(page.add_section(tr("Records")), figures.records, drawing);
    add_provenance(page.add_section(tr("Settings, inputs, warnings")), settings, sources.inputs,
                   tr("Remarks and warnings"), warnings);
    report.files.emplace_back("report.html", page.text());
    add_figure_files(report.files, all, drawing);
    return report;
}

}  // namespace a351::corrector::report
