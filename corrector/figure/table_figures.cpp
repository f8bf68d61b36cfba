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
    std::optional<MilliGal> u_y = {};

    [[nodiscard]] bool is_finite() const { return std::isfinite(x) && std::isfinite(y); }
};
using PointOf = std::function<Point(const model::CorrectedRow&)>;

double or_nan(const std::optional<MilliGal>& value) {
    return value ? value->value() : std::nan("");
}

/// Returns the standard error from the scatter of the samples, if there are samples.
std::optional<MilliGal> standard_error_of(const model::CorrectedRow& row) {
    return row.row.record ? row.row.record->standard_error : std::nullopt;
}

/// Returns a figure of points without data.
Figure scatter(const std::string& name, const std::string& x_label, const std::string& y_label,
               const std::string& caption, const Print& print) {
    Figure figure{
        name, caption, print.small_mm(), {{.x = {x_label}, .y = {y_label}, .has_margin = true}}};
    figure.panels.front().x.format = figure.panels.front().y.format = "%.6g";
    return figure;
}

/// Returns a whole 1000 from which an axis counts, which its label then says, if its numbers have
/// six digits; else 0.
double origin_of(Axis& axis, const std::vector<double>& values) {
    constexpr double kSixDigits = 1e5, kOffset = 1e3;
    const auto [least, greatest] = std::ranges::minmax(values);
    if (least < kSixDigits || greatest - least > 10.0 * kOffset) return 0.0;
    const double origin = kOffset * std::floor(least / kOffset);
    axis.label.insert(axis.label.rfind(" ("), fmt::format(" - {}", text::fixed(origin, 0)));
    return origin;
}

/// Adds the points of the rows and their least-squares line.
std::optional<Figure> with_rows(Figure figure, const model::SurveyCorrection& result,
                                const std::string& columns, const PointOf& point_of) {
    std::vector<double> all_x, all_y, x, y;  // of all points, and of those in the fit
    bool has_bars = false;
    for (const model::CorrectedRow& row : result.rows) {
        const Point point = point_of(row);
        if (!point.is_finite()) continue;
        all_x.push_back(point.x);
        all_y.push_back(point.y);
        if (row.is_used) {
            x.push_back(point.x);
            y.push_back(point.y);
        }
        has_bars = has_bars || point.u_y;
    }
    if (all_x.empty()) return std::nullopt;
    Panel& panel = figure.panels.front();
    const double x_0 = origin_of(panel.x, all_x), y_0 = origin_of(panel.y, all_y);
    plot_rows(figure, result, columns, [&](const model::CorrectedRow& row) -> std::string {
        const Point point = point_of(row);
        if (!point.is_finite()) return {};
        return data_line(
            "444", {point.x - x_0, point.y - y_0, point.u_y.value_or(MilliGal(0.0)).value()}, "");
    });
    if (has_bars) add_bars(panel);
    if (x.size() >= 3 && std::ranges::min(x) < std::ranges::max(x)) {
        const auto fit = signal::fit_line(x, y);
        std::string ends;
        for (const double end : {std::ranges::min(all_x), std::ranges::max(all_x)})
            ends += data_line("44", {end - x_0, fit.mean_y + fit.slope * (end - fit.mean_x) - y_0});
        figure.plot(
            "line through those in the fit: " + columns, ends,
            {.look = Look::line,
             .colour = Colour::grey,
             .label = tr("slope {}, R² = {}", text::fixed(fit.slope, 4), text::fixed(fit.r2, 4))});
    }
    return figure;
}

}  // namespace

std::optional<Figure> acceleration_figure(const model::SurveyCorrection& result,
                                          const Print& print) {
    if (model::has_two_faces(result.rows)) return std::nullopt;
    return with_rows(
        scatter("acceleration", tr("Reference gravity (mGal)"), tr("Acceleration (mGal)"),
                tr("Acceleration as measured, tide not removed, over reference gravity; "
                   "bars: standard error from the scatter of the samples; "
                   "least-squares line and R² of the readings in the fit (in sample).") +
                    as_published("12"),
                print),
        result, "reference_mgal acceleration_mgal u_mgal",
        [](const model::CorrectedRow& row) -> Point {
            return {or_nan(row.row.reference), row.row.acceleration.value(),
                    standard_error_of(row)};
        });
}

std::optional<Figure> difference_figure(const model::SurveyCorrection& result, const Print& print) {
    if (model::has_two_faces(result.rows)) return std::nullopt;
    return with_rows(
        scatter("difference", tr("Temperature (°C)"), tr("Acceleration - reference - tide (mGal)"),
                tr("Difference between the reading, tide removed, and reference gravity over "
                   "temperature; bars: standard error from the scatter of the samples; "
                   "least-squares line and R² of the readings in the fit (in sample; "
                   "temperature alone, whatever model was applied).") +
                    as_published("13"),
                print),
        result, "temperature_degc difference_mgal u_mgal",
        [](const model::CorrectedRow& row) -> Point {
            return {row.row.has_temperature ? row.row.temperature.value() : std::nan(""),
                    or_nan(row.difference), standard_error_of(row)};
        });
}

std::optional<Figure> corrected_figure(const model::SurveyCorrection& result, const Print& print) {
    return with_rows(
        scatter("corrected", tr("Reference gravity (mGal)"), tr("Corrected gravity (mGal)"),
                tr("Corrected gravity of each reading over reference gravity, with u as bars; "
                   "least-squares line and R² of the readings in the fit (in sample).") +
                    as_published("14"),
                print),
        result, "reference_mgal corrected_mgal u_mgal",
        [](const model::CorrectedRow& row) -> Point {
            return {or_nan(row.row.reference), row.corrected.value(), row.u_corrected};
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
                {Look::discs_with_bars, Colour::blue, tr("stations, u"), {1, 2, 3}});
    return figure;
}

}  // namespace a351::corrector::figure
