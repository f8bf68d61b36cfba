#include "corrector/figure/table_figures.hpp"

#include <algorithm>
#include <functional>

#include "corrector/figure/escaping.hpp"
#include "corrector/figure/reading_name.hpp"
#include "corrector/figure/time_axis.hpp"
#include "corrector/model/linear_fit.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {
namespace {

constexpr int kWidth_px = 640;
constexpr int kHeight_px = 440;

/// A group of rows and its mark in a figure.
struct Mark {
    std::string title;
    std::function<bool(const CorrectedRow&)> takes;
    std::string style;
};

const std::vector<Mark>& marks() {
    static const std::vector<Mark> all{
        {"in the fit", [](const CorrectedRow& row) { return row.is_used && !row.row.is_flagged; },
         "pt 7 ps 0.6 lc rgb " + kBlue},
        {"marked by the operator, in the fit",
         [](const CorrectedRow& row) { return row.is_used && row.row.is_flagged; },
         "pt 6 ps 0.7 lw 1.5 lc rgb " + kBlue},
        {"left out of the fit", [](const CorrectedRow& row) { return !row.is_used; },
         "pt 2 ps 0.7 lw 1.5 lc rgb " + kVermilion},
    };
    return all;
}

struct Point {
    double x = 0.0;
    double y = 0.0;
};
/// Function that returns the point of a row; std::nullopt if the row is not in the figure.
using PointOf = std::function<std::optional<Point>(const CorrectedRow&)>;

/// The line y = intercept + slope x through the rows in the fit.
struct Line {
    LinearFit fit;
    double least_x = 0.0;
    double greatest_x = 0.0;
};

std::optional<Line> line_through(const SurveyCorrection& result, const PointOf& point_of) {
    std::vector<double> x, y;
    double least = 0.0;
    double greatest = 0.0;
    bool is_first = true;
    for (const CorrectedRow& row : result.rows) {
        const auto point = point_of(row);
        if (!point) continue;
        least = is_first ? point->x : std::min(least, point->x);
        greatest = is_first ? point->x : std::max(greatest, point->x);
        is_first = false;
        if (!row.is_used) continue;
        x.push_back(point->x);
        y.push_back(point->y);
    }
    const auto n = static_cast<Eigen::Index>(x.size());
    const Eigen::MatrixXd columns = Eigen::Map<const Eigen::VectorXd>(x.data(), n);
    auto fit = fit_linear(columns, Eigen::Map<const Eigen::VectorXd>(y.data(), n));
    if (!fit || n < 3) return std::nullopt;
    return Line{std::move(*fit), least, greatest};
}

std::string line_lines(const Line& line) {
    std::string lines;
    for (const double x : {line.least_x, line.greatest_x}) {
        lines += datum(x, 4) + datum(line.fit.at(Eigen::VectorXd::Constant(1, x)), 4) + '\n';
    }
    return lines;
}

std::string line_title(const Line& line) {
    const double intercept = line.fit.coefficients(0);
    return "y = " + text::fixed(line.fit.coefficients(1), 4) + " x " +
           (intercept < 0.0 ? "- " : "+ ") + text::fixed(std::abs(intercept), 1) +
           ", R² = " + text::fixed(line.fit.r_squared, 4);
}

struct Scatter {
    std::string name, x_label, y_label, columns;
    PointOf point_of;
};

/// Returns one clause per group of rows with points; none if no row has a point.
std::vector<std::string> scatter_clauses(const SurveyCorrection& result, const Scatter& scatter,
                                         DataBlocks& data) {
    std::vector<std::string> clauses;
    for (const Mark& mark : marks()) {
        std::string lines;
        for (std::size_t i = 0; i < result.rows.size(); ++i) {
            const auto point = scatter.point_of(result.rows[i]);
            if (!point || !mark.takes(result.rows[i])) continue;
            lines += datum(point->x, 4) + datum(point->y, 4) + "# " +
                     clean_utf8(reading_name(result.rows, i)) + '\n';
        }
        const auto block = data.add(mark.title + ": " + scatter.columns, lines);
        if (!block) continue;
        clauses.push_back("'" + scatter.name + ".dat' index " + std::to_string(*block) +
                          " using 1:2 with points " + mark.style + " title '" + mark.title + "'");
    }
    return clauses;
}

std::string axes(const Scatter& scatter) {
    return "set xlabel '" + scatter.x_label + "'\nset ylabel '" + scatter.y_label +
           "'\n"
           "set offsets graph 0.03, graph 0.03, graph 0.05, graph 0.05\n";
}

std::optional<Figure> figure_with_line(const SurveyCorrection& result, const Scatter& scatter,
                                       const std::string& caption) {
    DataBlocks data;
    std::vector<std::string> clauses = scatter_clauses(result, scatter, data);
    if (clauses.empty()) return std::nullopt;
    if (const auto line = line_through(result, scatter.point_of)) {
        const auto block =
            data.add("line through those in the fit: " + scatter.columns, line_lines(*line));
        clauses.push_back("'" + scatter.name + ".dat' index " + std::to_string(block.value()) +
                          " using 1:2 with lines lw 1.2 lc rgb " + kGrey + " title '" +
                          line_title(*line) + "'");
    }
    return Figure{scatter.name, caption,
                  script_head(scatter.name, kWidth_px, kHeight_px) + axes(scatter) +
                      "set format '%.6g'\n" + plot_command(clauses) + script_tail(),
                  data.text()};
}

std::string residual_lines(const SurveyCorrection& result, const Mark& mark) {
    std::string lines;
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const CorrectedRow& row = result.rows[i];
        if (!row.residual || !mark.takes(row)) continue;
        lines += to_rfc3339(row.row.time) + ' ' + datum(row.residual->value(), 4) +
                 datum(row.u_corrected ? row.u_corrected->value() : 0.0, 4) + "# " +
                 clean_utf8(reading_name(result.rows, i)) + '\n';
    }
    return lines;
}

}  // namespace

std::optional<Figure> acceleration_figure(const SurveyCorrection& result) {
    const Scatter scatter{
        "acceleration", "Reference gravity (mGal)", "Acceleration (mGal)",
        "reference_mgal acceleration_mgal", [](const CorrectedRow& row) -> std::optional<Point> {
            if (!row.row.reference) return std::nullopt;
            return Point{row.row.reference->value(), row.row.acceleration.value()};
        }};
    return figure_with_line(result, scatter,
                            "Acceleration as measured, tide not removed, over reference gravity; "
                            "least-squares line through the readings in the fit.");
}

std::optional<Figure> difference_figure(const SurveyCorrection& result) {
    const Scatter scatter{
        "difference", "Temperature (°C)", "Acceleration - reference - tide (mGal)",
        "temperature_degc difference_mgal", [](const CorrectedRow& row) -> std::optional<Point> {
            if (!row.difference) return std::nullopt;
            return Point{row.row.temperature.value(), row.difference->value()};
        }};
    return figure_with_line(result, scatter,
                            "Difference between the reading, tide removed, and reference gravity "
                            "over temperature; least-squares line through the readings in the "
                            "fit (temperature alone, whatever model was applied).");
}

std::optional<Figure> corrected_figure(const SurveyCorrection& result) {
    const Scatter scatter{"corrected", "Reference gravity (mGal)", "Corrected gravity (mGal)",
                          "reference_mgal corrected_mgal",
                          [](const CorrectedRow& row) -> std::optional<Point> {
                              if (!row.row.reference) return std::nullopt;
                              return Point{row.row.reference->value(), row.corrected.value()};
                          }};
    DataBlocks data;
    std::vector<std::string> clauses = scatter_clauses(result, scatter, data);
    if (clauses.empty()) return std::nullopt;
    const auto line = line_through(result, scatter.point_of);
    clauses.push_back(
        "x with lines lw 1.2 lc rgb " + kGrey + " title 'y = x" +
        (line ? " (R² of the readings in the fit " + text::fixed(line->fit.r_squared, 4) + ")"
              : "") +
        "'");
    return Figure{scatter.name,
                  "Corrected gravity over reference gravity, with the line y = x. In sample: the "
                  "same references were used in the fit.",
                  script_head(scatter.name, kWidth_px, kHeight_px) + axes(scatter) +
                      "set format '%.6g'\n" + plot_command(clauses) + script_tail(),
                  data.text()};
}

std::optional<Figure> residual_figure(const SurveyCorrection& result) {
    const std::string kName = "residuals";
    DataBlocks data;
    std::vector<std::string> clauses{"0 with lines lw 1 lc rgb " + kGrey + " notitle"};
    for (const Mark& mark : marks()) {
        const auto block = data.add(mark.title + ": time_utc residual_mgal u_corrected_mgal",
                                    residual_lines(result, mark));
        if (!block) continue;
        const std::string source =
            "'" + kName + ".dat' index " + std::to_string(*block) + " using 1:2";
        clauses.push_back(source + ":3 with yerrorbars pt 0 lw 0.8 lc rgb '#bbbbbb' notitle");
        clauses.push_back(source + " with points " + mark.style + " title '" + mark.title + "'");
    }
    if (data.text().empty()) return std::nullopt;
    return Figure{
        kName,
        "Residuals (reference minus corrected) in time, in sample; bars: standard "
        "uncertainty " +
            std::string(result.model == "day" ? "of the prediction without the reading's station."
                        : result.network      ? "of a single reading, a priori."
                                              : "as of a new station, from the scatter in "
                                                "sample."),
        script_head(kName, 900, 430) + time_axis(result.rows) +
            "set ylabel 'Residual (mGal)'\n"
            "set offsets graph 0.02, graph 0.02, graph 0.03, graph 0.03\n" +
            plot_command(clauses) + script_tail(),
        data.text()};
}

}  // namespace a351::corrector
