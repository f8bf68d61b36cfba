#include "corrector/report/report.hpp"

#include <nlohmann/json.hpp>

#include "corrector/report/drawing.hpp"
#include "corrector/report/escaping.hpp"
#include "corrector/report/html.hpp"
#include "corrector/report/inline_svg.hpp"
#include "corrector/report/map_figure.hpp"
#include "corrector/report/reading_table.hpp"
#include "corrector/report/record_figures.hpp"
#include "corrector/report/result_tables.hpp"
#include "corrector/report/summary.hpp"
#include "corrector/report/table_figures.hpp"
#include "corrector/report/temperature_figure.hpp"

namespace a351::corrector {
namespace {

/// The figures by the section of the report they stand in.
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

const std::string* find_picture(const Drawing& drawing, const std::string& file) {
    for (const NamedText& picture : drawing.pictures) {
        if (picture.first == file) return &picture.second;
    }
    return nullptr;
}

std::string figure_html(const Figure& figure, const Drawing& drawing) {
    const std::string* const picture = find_picture(drawing, figure.name + ".svg");
    const auto svg = picture != nullptr ? inline_svg(*picture, figure.name + "-") : std::nullopt;
    return "<figure>\n" + svg.value_or("<p><em>This figure is missing.</em></p>") +
           "\n<figcaption>" + html_text(figure.caption) + " <code>" + figure.name +
           ".gp</code></figcaption>\n</figure>\n";
}

std::string figures_html(const std::vector<Figure>& figures, const Drawing& drawing) {
    std::string large, small;
    for (const Figure& figure : figures) {
        (figure.is_small ? small : large) += figure_html(figure, drawing);
    }
    return large + (small.empty() ? "" : "<div class=\"small\">\n" + small + "</div>\n");
}

/// One line however many figures have the same trouble.
std::vector<std::string> missing_lines(const std::vector<std::string>& troubles) {
    if (troubles.empty()) return {};
    const std::size_t others = troubles.size() - 1;
    return {"figures are missing: " + clean_utf8(troubles.front()) +
            (others == 0 ? std::string() : "; " + std::to_string(others) + " more such")};
}

std::string section(const std::string& title, const std::string& html) {
    return "<section>\n<h2>" + html_text(title) + "</h2>\n" + html + "</section>\n";
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
    for (const Figure& figure : figures.all()) {
        report.files.emplace_back("figures/" + figure.name + ".gp", figure.script);
        if (!figure.data.empty()) {
            report.files.emplace_back("figures/" + figure.name + ".dat", figure.data);
        }
    }
    for (NamedText& picture : drawing.pictures) {
        report.files.emplace_back("figures/" + picture.first, std::move(picture.second));
    }
    return report;
}

}  // namespace a351::corrector
