#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "corrector/figure/escaping.hpp"
#include "corrector/figure/row_marks.hpp"
#include "corrector/figure/survey_figures.hpp"
#include "protocol/signal/regression.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {
namespace {

using text::tr;

/// A point of a figure; a row without a finite one is not in it.
struct Point {
    double x, y;
};
using PointOf = std::function<Point(const model::CorrectedRow&)>;

double or_nan(const std::optional<MilliGal>& value) {
    return value ? value->value() : std::nan("");
}

/// Returns a figure of points without data.
Figure scatter(const std::string& name, const std::string& x_label, const std::string& y_label,
               const std::string& caption, const Print& print) {
    Figure figure{
        name, caption, print.small_mm(), {{.x = {x_label}, .y = {y_label}, .has_margin = true}}};
    figure.panels.front().x.format = figure.panels.front().y.format = "%.6g";
    return figure;
}

/// Adds the points of the rows and their least-squares line.
std::optional<Figure> with_rows(Figure figure, const model::SurveyCorrection& result,
                                const std::string& columns, const PointOf& point_of) {
    std::vector<double> all_x, x, y;  // of all points, and of those in the fit
    plot_rows(figure, result, columns, [&](const model::CorrectedRow& row) -> std::string {
        const Point point = point_of(row);
        if (!std::isfinite(point.x) || !std::isfinite(point.y)) return {};
        all_x.push_back(point.x);
        if (row.is_used) {
            x.push_back(point.x);
            y.push_back(point.y);
        }
        return data_line("44", {point.x, point.y}, "");
    });
    if (figure.data.empty()) return std::nullopt;
    if (x.size() < 3 || !(std::ranges::min(x) < std::ranges::max(x))) return figure;
    const auto fit = signal::fit_line(x, y);
    const auto at = [&fit](double where) { return fit.mean_y + fit.slope * (where - fit.mean_x); };
    std::string ends;
    for (const double end : {std::ranges::min(all_x), std::ranges::max(all_x)})
        ends += data_line("44", {end, at(end)});
    figure.plot("line through those in the fit: " + columns, ends,
                {.look = Look::line,
                 .colour = Colour::grey,
                 .label = fmt::format("y = {} x {} {}, R² = {}", text::fixed(fit.slope, 4),
                                      at(0.0) < 0.0 ? "-" : "+", text::fixed(std::abs(at(0.0)), 1),
                                      text::fixed(fit.r2, 4))});
    return figure;
}

}  // namespace

std::optional<Figure> acceleration_figure(const model::SurveyCorrection& result,
                                          const Print& print) {
    return with_rows(
        scatter("acceleration", tr("Reference gravity (mGal)"), tr("Acceleration (mGal)"),
                tr("Acceleration as measured, tide not removed, over reference gravity; "
                   "least-squares line and R² of the readings in the fit (in sample)."),
                print),
        result, "reference_mgal acceleration_mgal", [](const model::CorrectedRow& row) -> Point {
            return {or_nan(row.row.reference), row.row.acceleration.value()};
        });
}

std::optional<Figure> difference_figure(const model::SurveyCorrection& result, const Print& print) {
    return with_rows(
        scatter("difference", tr("Temperature (°C)"), tr("Acceleration - reference - tide (mGal)"),
                tr("Difference between the reading, tide removed, and reference gravity over "
                   "temperature; least-squares line and R² of the readings in the fit (in sample; "
                   "temperature alone, whatever model was applied)."),
                print),
        result, "temperature_degc difference_mgal", [](const model::CorrectedRow& row) -> Point {
            return {row.row.has_temperature ? row.row.temperature.value() : std::nan(""),
                    or_nan(row.difference)};
        });
}

std::optional<Figure> side_by_side_figure(const model::SurveyCorrection& result,
                                          const Print& print) {
    if (!result.side_by_side || result.side_by_side->stations.empty()) return std::nullopt;
    Figure figure = scatter(
        "side-by-side", tr("Gravity by the reference gravimeter (mGal)"),
        tr("Ours minus theirs (mGal)"),
        tr("Gravity by the sensor minus that by the reference gravimeter, over gravity. Each "
           "station has its own reference hidden (cross-validated); bars are the standard "
           "uncertainty of the sensor."),
        print);
    std::string lines;
    for (const model::ComparedStation& station : result.side_by_side->stations)
        lines += data_line(
            "444", {station.theirs.value(), station.difference().value(), station.u_ours.value()},
            "# " + clean_utf8(station.site) + '\n');
    figure.panels.front().series = {{.look = Look::line, .colour = Colour::grey, .source = kZero}};
    figure.plot("stations: theirs_mgal difference_mgal u_ours_mgal", lines,
                {Look::discs_with_bars, Colour::blue, tr("stations, u"), {{1}, {2}, {3}}});
    return figure;
}

}  // namespace a351::corrector::figure
