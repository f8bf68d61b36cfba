#include <fmt/core.h>

#include <algorithm>

#include "corrector/correlation/regression.hpp"
#include "corrector/figure/long_record_figures.hpp"
#include "protocol/core/units.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {
namespace {

/// Returns hours and deviations from the mean.  Neighbours are averaged so that the curve has at
/// most kMostPoints.
std::string curve_lines(const std::vector<double>& values, double step_s) {
    const double mean = correlation::mean_of(values);
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

Figure series_figure(const long_record::RecordResult& result) {
    FigureData data("before-after");
    std::string panels;
    const auto panel = [&](const std::string& title, const std::vector<double>& values,
                           const std::string& colour) {
        const std::string block = data.add(fmt::format("hours {} (mGal)", title),
                                           curve_lines(values, result.record.step_s));
        panels += fmt::format(
            "set ylabel '{} (mGal)'\n{}", text::translated(title, text::language()),
            plot_command(
                {fmt::format("{} using 1:2 with lines lc rgb {} notitle", block, colour)}));
    };
    const std::vector<double>& before = result.segment().acceleration_mgal;
    const auto [low, high] = std::minmax_element(before.begin(), before.end());
    const double mean = correlation::mean_of(before);
    panel(text::marked("Before"), before, kGrey);
    panel(text::marked("Parametric"), result.applied->parametric_mgal, kBlue);
    panels += fmt::format("set xlabel '{}'\n",
                          text::tr("Hours after {}", to_rfc3339(result.segment().start)));
    panel(text::marked("By modes"), result.applied->by_modes_mgal, kVermilion);
    return data.figure(
        text::tr(
            "The record minus its mean, before and after the correction by each of two methods."),
        900, 640,
        fmt::format(
            "set multiplot layout 3,1\nset lmargin 12\nset yrange [{}:{}]\n{}unset multiplot\n",
            datum(*low - mean - 1.0, 1), datum(*high - mean + 1.0, 1), panels));
}

Figure allan_figure(const long_record::RecordResult& result) {
    std::string lines;
    for (const long_record::AllanPoint& point : result.applied->allan)
        lines += datum(point.averaging_s, 0) + datum(point.deviation_mgal.before, 5) +
                 datum(point.deviation_mgal.parametric, 5) +
                 datum(point.deviation_mgal.by_modes, 5) + '\n';
    FigureData data("allan");
    const std::string block = data.add("averaging_s before parametric by_modes (mGal)", lines);
    const auto curve = [&](int column, const std::string& colour, const char* title) {
        return fmt::format("{} using 1:{} with linespoints pt 7 ps 0.5 lc rgb {} title '{}'", block,
                           column, colour, text::translated(title, text::language()));
    };
    return data.figure(
        text::tr(
            "Allan deviation before and after the correction: scatter of averages over this time."),
        900, 400,
        fmt::format("set logscale xy\nset xlabel '{}'\nset ylabel '{}'\n",
                    text::tr("Averaging (s)"), text::tr("Allan deviation (mGal)")) +
            plot_command({curve(2, kGrey, text::marked("before")),
                          curve(3, kBlue, text::marked("parametric")),
                          curve(4, kVermilion, text::marked("by modes"))}));
}

}  // namespace

std::vector<Figure> applied_figures(const long_record::RecordResult& result) {
    return {series_figure(result), allan_figure(result)};
}

}  // namespace a351::corrector::figure
