#include <fmt/core.h>

#include <algorithm>

#include "corrector/figure/long_record_figures.hpp"
#include "protocol/core/units.hpp"
#include "protocol/signal/moments.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {
namespace {

using text::tr;

/// Returns hours and deviations from the mean.  Neighbours are averaged so that the curve has at
/// most kMostPoints.
std::string mean_lines(const std::vector<double>& values, double step_s) {
    const double mean = signal::mean_of(values);
    const std::size_t each = (values.size() + kMostPoints - 1) / kMostPoints;
    std::string lines;
    for (std::size_t first = 0; first + each <= values.size(); first += each) {
        double sum = 0.0;
        for (std::size_t i = first; i < first + each; ++i) sum += values[i] - mean;
        const double middle = static_cast<double>(first) + 0.5 * static_cast<double>(each - 1);
        lines +=
            data_line("54", {middle * step_s / kSecondsPerHour, sum / static_cast<double>(each)});
    }
    return lines;
}

Figure series_figure(const long_record::RecordResult& result, const Print& print) {
    const std::vector<double>& before = result.segment().quantity;
    const double low = std::ranges::min(before), high = std::ranges::max(before),
                 mean = signal::mean_of(before);
    Figure figure{"before-after",
                  tr("The record minus its mean, before and after the correction by each of two "
                     "methods."),
                  print.wide_mm()};
    const auto add = [&](const char* title, const std::vector<double>& values, Colour colour) {
        figure.panels.push_back(
            {.y = {text::translated(title) + " (mGal)", {low - mean - 1.0, high - mean + 1.0}},
             .height_mm = kStackedPanel_mm});
        figure.plot(fmt::format("hours {} (mGal)", title), mean_lines(values, result.record.step_s),
                    {Look::line, colour}, figure.panels.size() - 1);
    };
    add(text::marked("Before"), before, Colour::grey);
    add(text::marked("Parametric"), result.applied->parametric_mgal, Colour::blue);
    add(text::marked("By modes"), result.applied->by_modes_mgal, Colour::vermilion);
    figure.panels.back().x.label = tr("Hours after {}", to_rfc3339(result.segment().start));
    return figure;
}

Figure allan_figure(const long_record::RecordResult& result, const Print& print) {
    Figure figure{
        "allan",
        tr("Allan deviation before and after the correction: scatter of averages over this time."),
        print.small_mm()};
    std::string lines;
    for (const auto& [averaging_s, deviation] : result.applied->allan)
        lines += data_line(
            "0555", {averaging_s, deviation.before, deviation.parametric, deviation.by_modes});
    const std::string source = figure.add("averaging_s before parametric by_modes (mGal)", lines);
    figure.panels = {{{.label = tr("Averaging (s)"), .scale = Scale::logarithmic},
                      {.label = tr("Allan deviation (mGal)"), .scale = Scale::logarithmic},
                      {{Look::linked_discs, Colour::grey, tr("before"), {1, 2}, source},
                       {Look::linked_triangles, Colour::blue, tr("parametric"), {1, 3}, source},
                       {Look::linked_squares, Colour::vermilion, tr("by modes"), {1, 4}, source}}}};
    return figure;
}

}  // namespace

std::vector<Figure> applied_figures(const long_record::RecordResult& result, const Print& print) {
    return {series_figure(result, print), allan_figure(result, print)};
}

}  // namespace a351::corrector::figure
