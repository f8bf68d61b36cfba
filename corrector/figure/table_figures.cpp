#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "corrector/figure/escaping.hpp"
#include "corrector/figure/row_marks.hpp"
#include "corrector/figure/survey_figures.hpp"
#include "corrector/model/paper_correction.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {
namespace {

struct Point {
    double x = 0.0;
    double y = 0.0;
};
/// Function that returns the point of a row; std::nullopt if the row is not in the figure.
using PointOf = std::function<std::optional<Point>(const model::CorrectedRow&)>;

/// The line y = intercept + slope x through the rows in the fit.
struct Line {
    model::Line fit;
    double least_x = 0.0;
    double greatest_x = 0.0;
};

std::optional<Line> line_through(const model::SurveyCorrection& result, const PointOf& point_of) {
    std::vector<double> all_x, x, y;
    for (const model::CorrectedRow& row : result.rows) {
        const auto point = point_of(row);
        if (!point) continue;
        all_x.push_back(point->x);
        if (!row.is_used) continue;
        x.push_back(point->x);
        y.push_back(point->y);
    }
    const auto fit = model::fit_line(x, y);
    if (!fit || fit->count < 3) return std::nullopt;
    const auto [least, greatest] = std::ranges::minmax(all_x);
    return Line{*fit, least, greatest};
}

std::string line_lines(const Line& line) {
    std::string lines;
    for (const double x : {line.least_x, line.greatest_x})
        lines += datum(x, 4) + datum(line.fit.at(x), 4) + '\n';
    return lines;
}

std::string line_title(const Line& line) {
    const double intercept = line.fit.intercept;
    return fmt::format("y = {} x {} {}, R² = {}", text::fixed(line.fit.slope, 4),
                       intercept < 0.0 ? "-" : "+", text::fixed(std::abs(intercept), 1),
                       text::fixed(line.fit.r_squared, 4));
}

struct Scatter {
    const char *name, *x_label, *y_label, *columns;
    PointOf point_of;
};

/// Returns one clause per group of rows with points; none if no row has a point.
std::vector<std::string> scatter_clauses(const model::SurveyCorrection& result,
                                         const Scatter& scatter, FigureData& data) {
    std::vector<std::string> clauses;
    for (const Mark& mark : marks()) {
        std::string lines;
        for (std::size_t i = 0; i < result.rows.size(); ++i) {
            const auto point = scatter.point_of(result.rows[i]);
            if (!point || !mark.takes(result.rows[i])) continue;
            lines += datum(point->x, 4) + datum(point->y, 4) + comment(result, i);
        }
        const std::string source =
            data.add(fmt::format("{}: {}", mark.title, scatter.columns), lines);
        if (source.empty()) continue;
        clauses.push_back(fmt::format("{} using 1:2 with points {} title '{}'", source, mark.style,
                                      text::translated(mark.title, text::language())));
    }
    return clauses;
}

Figure scatter_plot(const FigureData& data, const Scatter& scatter, const std::string& caption,
                    const std::vector<std::string>& clauses) {
    return data.figure(
        caption, 480, 360,
        fmt::format("set xlabel '{}'\nset ylabel '{}'\n"
                    "set offsets graph 0.03, graph 0.03, graph 0.05, graph 0.05\n"
                    "set format '%.6g'\n{}",
                    text::translated(scatter.x_label, text::language()),
                    text::translated(scatter.y_label, text::language()), plot_command(clauses)));
}

std::optional<Figure> figure_with_line(const model::SurveyCorrection& result,
                                       const Scatter& scatter, const std::string& caption) {
    FigureData data(scatter.name);
    std::vector<std::string> clauses = scatter_clauses(result, scatter, data);
    if (clauses.empty()) return std::nullopt;
    if (const auto line = line_through(result, scatter.point_of)) {
        const std::string source = data.add(
            fmt::format("line through those in the fit: {}", scatter.columns), line_lines(*line));
        clauses.push_back(fmt::format("{} using 1:2 with lines lw 1.2 lc rgb {} title '{}'", source,
                                      kGrey, line_title(*line)));
    }
    return scatter_plot(data, scatter, caption, clauses);
}

}  // namespace

std::optional<Figure> acceleration_figure(const model::SurveyCorrection& result) {
    const Scatter scatter{
        "acceleration", text::marked("Reference gravity (mGal)"),
        text::marked("Acceleration (mGal)"), "reference_mgal acceleration_mgal",
        [](const model::CorrectedRow& row) -> std::optional<Point> {
            if (!row.row.reference) return std::nullopt;
            return Point{row.row.reference->value(), row.row.acceleration.value()};
        }};
    return figure_with_line(
        result, scatter,
        text::tr("Acceleration as measured, tide not removed, over reference gravity; "
                 "least-squares line and R² of the readings in the fit (in sample)."));
}

std::optional<Figure> difference_figure(const model::SurveyCorrection& result) {
    const Scatter scatter{"difference", text::marked("Temperature (°C)"),
                          text::marked("Acceleration - reference - tide (mGal)"),
                          "temperature_degc difference_mgal",
                          [](const model::CorrectedRow& row) -> std::optional<Point> {
                              if (!row.difference || !row.row.has_temperature) return std::nullopt;
                              return Point{row.row.temperature.value(), row.difference->value()};
                          }};
    return figure_with_line(
        result, scatter,
        text::tr("Difference between the reading, tide removed, and reference gravity "
                 "over temperature; least-squares line and R² of the readings in "
                 "the fit (in sample; temperature alone, whatever model was applied)."));
}

std::optional<Figure> corrected_figure(const model::SurveyCorrection& result) {
    const Scatter scatter{"corrected", text::marked("Reference gravity (mGal)"),
                          text::marked("Corrected gravity (mGal)"), "reference_mgal corrected_mgal",
                          [](const model::CorrectedRow& row) -> std::optional<Point> {
                              if (!row.row.reference) return std::nullopt;
                              return Point{row.row.reference->value(), row.corrected.value()};
                          }};
    FigureData data(scatter.name);
    std::vector<std::string> clauses = scatter_clauses(result, scatter, data);
    if (clauses.empty()) return std::nullopt;
    const auto line = line_through(result, scatter.point_of);
    clauses.push_back(fmt::format(
        "x with lines lw 1.2 lc rgb {} title 'y = x{}'", kGrey,
        line ? text::tr(" (R² of the readings in the fit {})", text::fixed(line->fit.r_squared, 4))
             : ""));
    return scatter_plot(
        data, scatter,
        text::tr("Corrected gravity over reference gravity, with the line y = x. In sample: "
                 "the same references were used in the fit."),
        clauses);
}

std::optional<Figure> side_by_side_figure(const model::SurveyCorrection& result) {
    if (!result.side_by_side || result.side_by_side->stations.empty()) return std::nullopt;
    FigureData data("side-by-side");
    std::string lines;
    for (const model::ComparedStation& station : result.side_by_side->stations)
        lines += datum(station.theirs.value(), 4) + datum(station.difference().value(), 4) +
                 datum(station.u_ours.value(), 4) + "# " + clean_utf8(station.site) + '\n';
    const std::string source = data.add("stations: theirs_mgal difference_mgal u_ours_mgal", lines);
    const std::vector<std::string> clauses{
        fmt::format("0 with lines lw 1.2 lc rgb {} notitle", kGrey),
        fmt::format("{} using 1:2:3 with yerrorbars pt 7 ps 0.6 lc rgb {} title '{}'", source,
                    kBlue, text::tr("stations, u"))};
    return data.figure(
        text::tr("Gravity by the sensor minus that by the reference gravimeter, over gravity. Each "
                 "station "
                 "has its own reference hidden (cross-validated); bars are the standard "
                 "uncertainty of the "
                 "sensor."),
        480, 360,
        fmt::format("set xlabel '{}'\nset ylabel '{}'\n",
                    text::tr("Gravity by the reference gravimeter (mGal)"),
                    text::tr("Ours minus theirs (mGal)")) +
            "set offsets graph 0.03, graph 0.03, graph 0.05, graph 0.05\nset format '%.6g'\n" +
            plot_command(clauses));
}

}  // namespace a351::corrector::figure
