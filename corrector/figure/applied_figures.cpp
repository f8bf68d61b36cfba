#include "corrector/figure/applied_figures.hpp"

#include <algorithm>
#include <cmath>

#include "corrector/correlation/regression.hpp"
#include "protocol/core/units.hpp"

namespace a351::corrector {
namespace {

/// Returns hours and deviations from the mean.  Neighbours are averaged so that the curve has at
/// most kMostPoints.
std::string curve_lines(const std::vector<double>& values, double step_s) {
    const double mean = mean_of(values);
    const std::size_t each = (values.size() + kMostPoints - 1) / kMostPoints;
    std::string lines;
    for (std::size_t first = 0; first + each <= values.size(); first += each) {
        double sum = 0.0;
        for (std::size_t i = first; i < first + each; ++i) sum += values[i] - mean;
        const double middle = static_cast<double>(first) + 0.5 * static_cast<double>(each - 1);
        lines += datum(middle * step_s / kSecondsPerHour, 5) +
                 datum(sum / static_cast<double>(each), 4) + '\n';
    }
    return lines;
}

Figure series_figure(const RecordResult& result) {
    const std::string kName = "before-after";
    const double step_s = result.record.step_s;
    DataBlocks data;
    std::string panels;
    const auto panel = [&](const std::string& title, const std::vector<double>& values,
                           const std::string& colour) {
        const auto block = data.add("hours " + title + " (mGal)", curve_lines(values, step_s));
        panels += "set ylabel '" + title + " (mGal)'\n" +
                  plot_command({block_clause(
                      kName, block, "using 1:2 with lines lc rgb " + colour + " notitle")});
    };
    const auto [low, high] = std::minmax_element(result.segment().acceleration_mgal.begin(),
                                                 result.segment().acceleration_mgal.end());
    const double mean = mean_of(result.segment().acceleration_mgal);
    const std::string range =
        "set yrange [" + datum(*low - mean - 1.0, 1) + ":" + datum(*high - mean + 1.0, 1) + "]\n";
    panel("Before", result.segment().acceleration_mgal, kGrey);
    panel("Parametric", result.applied->parametric_mgal, kBlue);
    panels += "set xlabel 'Hours after " + to_rfc3339(result.segment().start) + "'\n";
    panel("By modes", result.applied->by_modes_mgal, kVermilion);
    return {kName,
            "The record minus its mean, before and after the correction by each of two methods.",
            script_head(kName, 900, 640) + "set multiplot layout 3,1\nset lmargin 12\n" + range +
                panels + "unset multiplot\n" + script_tail(),
            data.text()};
}

Figure allan_figure(const RecordResult& result) {
    const std::string kName = "allan";
    std::string lines;
    for (const AllanPoint& point : result.applied->allan)
        lines += datum(point.averaging_s, 0) + datum(point.deviation_mgal.before, 5) +
                 datum(point.deviation_mgal.parametric, 5) +
                 datum(point.deviation_mgal.by_modes, 5) + '\n';
    DataBlocks data;
    const auto block = data.add("averaging_s before parametric by_modes (mGal)", lines);
    const auto curve = [&](const std::string& column, const std::string& colour,
                           const std::string& title) {
        return block_clause(kName, block,
                            "using 1:" + column + " with linespoints pt 7 ps 0.5 lc rgb " + colour +
                                " title '" + title + "'");
    };
    return {kName,
            "Allan deviation before and after the correction: scatter of averages over this time.",
            script_head(kName, 900, 400) +
                "set logscale xy\nset xlabel 'Averaging (s)'\nset ylabel 'Allan deviation "
                "(mGal)'\n" +
                plot_command({curve("2", kGrey, "before"), curve("3", kBlue, "parametric"),
                              curve("4", kVermilion, "by modes")}) +
                script_tail(),
            data.text()};
}

}  // namespace

std::vector<Figure> applied_figures(const RecordResult& result) {
    return {series_figure(result), allan_figure(result)};
}

}  // namespace a351::corrector
