#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>

#include "corrector/figure/escaping.hpp"
#include "corrector/figure/reading_name.hpp"
#include "corrector/figure/survey_figures.hpp"
#include "corrector/model/linear_fit.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::figure {
namespace {

/// A group of rows and its mark in a figure.
struct Mark {
    std::string title;
    std::function<bool(const model::CorrectedRow&)> takes;
    std::string style;
};

const std::vector<Mark>& marks() {
    static const std::vector<Mark> all{
        {"in the fit",
         [](const model::CorrectedRow& row) { return row.is_used && !row.row.is_flagged; },
         "pt 7 ps 0.6 lc rgb " + kBlue},
        {"marked by the operator, in the fit",
         [](const model::CorrectedRow& row) { return row.is_used && row.row.is_flagged; },
         "pt 6 ps 0.7 lw 1.5 lc rgb " + kBlue},
        {"left out of the fit", [](const model::CorrectedRow& row) { return !row.is_used; },
         "pt 2 ps 0.7 lw 1.5 lc rgb " + kVermilion},
    };
    return all;
}

struct Point {
    double x = 0.0;
    double y = 0.0;
};
/// Function that returns the point of a row; std::nullopt if the row is not in the figure.
using PointOf = std::function<std::optional<Point>(const model::CorrectedRow&)>;

/// The line y = intercept + slope x through the rows in the fit.
struct Line {
    model::LinearFit fit;
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
    const auto n = static_cast<Eigen::Index>(x.size());
    const Eigen::MatrixXd columns = Eigen::Map<const Eigen::VectorXd>(x.data(), n);
    auto fit = model::fit_linear(columns, Eigen::Map<const Eigen::VectorXd>(y.data(), n));
    if (!fit || n < 3) return std::nullopt;
    const auto [least, greatest] = std::ranges::minmax(all_x);
    return Line{std::move(*fit), least, greatest};
}

std::string line_lines(const Line& line) {
    std::string lines;
    for (const double x : {line.least_x, line.greatest_x})
        lines += datum(x, 4) + datum(line.fit.at(Eigen::VectorXd::Constant(1, x)), 4) + '\n';
    return lines;
}

std::string line_title(const Line& line) {
    const double intercept = line.fit.coefficients(0);
    return fmt::format("y = {} x {} {}, R² = {}", text::fixed(line.fit.coefficients(1), 4),
                       intercept < 0.0 ? "-" : "+", text::fixed(std::abs(intercept), 1),
                       text::fixed(line.fit.r_squared, 4));
}

/// Returns the comment of a row in data: its reading.
std::string comment(const model::SurveyCorrection& result, std::size_t row) {
    return fmt::format("# {}\n", clean_utf8(reading_name(result.rows, row)));
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
        clauses.push_back(
            fmt::format("{} using 1:2 with points {} title '{}'", source, mark.style, mark.title));
    }
    return clauses;
}

Figure scatter_plot(const FigureData& data, const Scatter& scatter, const std::string& caption,
                    const std::vector<std::string>& clauses) {
    return data.figure(caption, 640, 440,
                       fmt::format("set xlabel '{}'\nset ylabel '{}'\n"
                                   "set offsets graph 0.03, graph 0.03, graph 0.05, graph 0.05\n"
                                   "set format '%.6g'\n{}",
                                   scatter.x_label, scatter.y_label, plot_command(clauses)));
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

std::string residual_lines(const model::SurveyCorrection& result, const Mark& mark) {
    std::string lines;
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const model::CorrectedRow& row = result.rows[i];
        if (!row.residual || !mark.takes(row)) continue;
        lines += fmt::format("{} {}{}{}", to_rfc3339(row.row.time), datum(row.residual->value(), 4),
                             datum(row.u_corrected ? row.u_corrected->value() : 0.0, 4),
                             comment(result, i));
    }
    return lines;
}

/// Returns script lines for data whose first column is an instant in RFC 3339.  UTC is below the
/// figure; the stays are above it, at the instants of their first readings.
std::string time_axis(const std::vector<model::CorrectedRow>& rows) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const reading::SurveyRow& row = rows[i].row;
        const bool is_further_set_up = i > 0 && rows[i - 1].row.site == row.site &&
                                       rows[i - 1].row.occupation == row.occupation;
        if (is_further_set_up) continue;
        names.push_back(fmt::format(
            "{} '{}'",
            gnuplot_string(fmt::format("{} ({})", short_label(row.site), row.occupation)),
            to_rfc3339(row.time)));
    }
    // Longest survey whose axis shows only hours; a longer one needs the date too.
    constexpr std::chrono::hours kLongestDay(36);
    const UtcTime first = rows.front().row.time;
    const UtcTime last = rows.back().row.time;
    const std::string first_date = to_rfc3339(first).substr(0, 10);
    const std::string last_date = to_rfc3339(last).substr(0, 10);
    return fmt::format(
        "set xdata time\nset x2data time\nset timefmt '%Y-%m-%dT%H:%M:%SZ'\nset format x {}\n"
        "set link x2\nset xlabel 'UTC, {}{}'\nset xtics nomirror\nset grid x2tics noxtics\n"
        "set x2tics scale 0 rotate by 90 left font ',10' ({})\n",
        last - first > kLongestDay ? "\"%H:%M\\n%m-%d\"" : "'%H:%M'", first_date,
        first_date == last_date ? "" : " to " + last_date, text::joined(names, ", \\\n    "));
}

}  // namespace

std::optional<Figure> acceleration_figure(const model::SurveyCorrection& result) {
    const Scatter scatter{
        "acceleration", "Reference gravity (mGal)", "Acceleration (mGal)",
        "reference_mgal acceleration_mgal",
        [](const model::CorrectedRow& row) -> std::optional<Point> {
            if (!row.row.reference) return std::nullopt;
            return Point{row.row.reference->value(), row.row.acceleration.value()};
        }};
    return figure_with_line(result, scatter,
                            "Acceleration as measured, tide not removed, over reference gravity; "
                            "least-squares line through the readings in the fit.");
}

std::optional<Figure> difference_figure(const model::SurveyCorrection& result) {
    const Scatter scatter{"difference", "Temperature (°C)",
                          "Acceleration - reference - tide (mGal)",
                          "temperature_degc difference_mgal",
                          [](const model::CorrectedRow& row) -> std::optional<Point> {
                              if (!row.difference) return std::nullopt;
                              return Point{row.row.temperature.value(), row.difference->value()};
                          }};
    return figure_with_line(result, scatter,
                            "Difference between the reading, tide removed, and reference gravity "
                            "over temperature; least-squares line through the readings in the "
                            "fit (temperature alone, whatever model was applied).");
}

std::optional<Figure> corrected_figure(const model::SurveyCorrection& result) {
    const Scatter scatter{"corrected", "Reference gravity (mGal)", "Corrected gravity (mGal)",
                          "reference_mgal corrected_mgal",
                          [](const model::CorrectedRow& row) -> std::optional<Point> {
                              if (!row.row.reference) return std::nullopt;
                              return Point{row.row.reference->value(), row.corrected.value()};
                          }};
    FigureData data(scatter.name);
    std::vector<std::string> clauses = scatter_clauses(result, scatter, data);
    if (clauses.empty()) return std::nullopt;
    const auto line = line_through(result, scatter.point_of);
    clauses.push_back(fmt::format("x with lines lw 1.2 lc rgb {} title 'y = x{}'", kGrey,
                                  line ? fmt::format(" (R² of the readings in the fit {})",
                                                     text::fixed(line->fit.r_squared, 4))
                                       : ""));
    return scatter_plot(data, scatter,
                        "Corrected gravity over reference gravity, with the line y = x. In sample: "
                        "the same references were used in the fit.",
                        clauses);
}

std::optional<Figure> residual_figure(const model::SurveyCorrection& result) {
    FigureData data("residuals");
    std::vector<std::string> clauses{"0 with lines lw 1 lc rgb " + kGrey + " notitle"};
    for (const Mark& mark : marks()) {
        const std::string source = data.add(
            mark.title + ": time_utc residual_mgal u_corrected_mgal", residual_lines(result, mark));
        if (source.empty()) continue;
        clauses.push_back(source +
                          " using 1:2:3 with yerrorbars pt 0 lw 0.8 lc rgb '#bbbbbb' notitle");
        clauses.push_back(
            fmt::format("{} using 1:2 with points {} title '{}'", source, mark.style, mark.title));
    }
    if (clauses.size() == 1) return std::nullopt;
    return data.figure(
        fmt::format("Residuals (reference minus corrected) in time, in sample; bars: standard "
                    "uncertainty {}",
                    result.as<model::WholeDayPart>() != nullptr
                        ? "of the prediction without the reading's station."
                    : result.as<model::NetworkAdjustment>() != nullptr
                        ? "of a single reading, a priori."
                        : "as of a new station, from the scatter in sample."),
        900, 430,
        fmt::format("{}set ylabel 'Residual (mGal)'\n"
                    "set offsets graph 0.02, graph 0.02, graph 0.03, graph 0.03\n{}",
                    time_axis(result.rows), plot_command(clauses)));
}

Figure temperature_figure(const model::SurveyCorrection& result,
                          const std::vector<reading::MinuteTemperature>& course) {
    std::string course_lines, reading_lines, intervals;
    for (std::size_t i = 0; i < course.size(); ++i) {
        const bool is_gap =
            i > 0 && course[i].middle - course[i - 1].middle > std::chrono::minutes(1);
        course_lines += fmt::format("{}{} {}\n", is_gap ? "\n" : "", to_rfc3339(course[i].middle),
                                    datum(course[i].mean.value(), 4));
    }
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const reading::SurveyRow& row = result.rows[i].row;
        reading_lines += fmt::format("{} {}{}", to_rfc3339(row.time),
                                     datum(row.temperature.value(), 4), comment(result, i));
        if (!row.start || !row.end) continue;
        intervals += fmt::format(
            "set object rectangle from '{}',graph 0 to '{}',graph 1 fc rgb '#d9ecf7' fs solid "
            "noborder behind\n",
            to_rfc3339(*row.start), to_rfc3339(*row.end));
    }
    FigureData data("temperature");
    std::vector<std::string> clauses;
    const std::string means =
        data.add("means of a minute: time_utc temperature_degc", course_lines);
    if (!means.empty()) {
        clauses.push_back(
            fmt::format("{} using 1:2 with lines lw 1.2 lc rgb {} title 'means of a minute'", means,
                        kVermilion));
    }
    clauses.push_back(fmt::format("{} using 1:2 with points pt 7 ps 0.6 lc rgb {} title 'readings'",
                                  data.add("readings: time_utc temperature_degc", reading_lines),
                                  kBlue));
    return data.figure(
        course.empty() ? "Temperature of the readings."
                       : "Temperature of the sensor over the day; shaded: the averaged intervals.",
        900, 400,
        fmt::format("{}set ylabel 'Temperature (°C)'\n"
                    "set offsets graph 0.02, graph 0.02, graph 0.05, graph 0.05\n{}{}",
                    time_axis(result.rows), intervals, plot_command(clauses)));
}

}  // namespace a351::corrector::figure
