#include "corrector/figure/long_record_figures.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "corrector/figure/record_curve.hpp"
#include "protocol/core/units.hpp"
#include "protocol/signal/moments.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {
namespace {

using long_record::RecordResult, long_record::RecordStretch;
using text::tr;

/// Returns the mean acceleration rounded to whole mGal, so that the axis is easy to read.
double reference_of(const RecordResult& result) {
    return std::round(signal::mean_of(result.segment().quantity));
}

std::string above_reference(const RecordResult& result) {
    return tr("Acceleration - {} (mGal)", text::fixed(reference_of(result), 0));
}

/// Returns slope and R2 of a published line.
/// @param key  beginning of the names of its statistics.
std::string published_line(const RecordResult& result, const std::string& key) {
    return fmt::format("{} mGal/°C, R² = {}", published_value(result, key + "_slope_mgal_per_degc"),
                       published_value(result, key + "_r2"));
}

/// Returns a figure of the acceleration above the temperature.
Figure two_panels(const std::string& name, const std::string& caption, UtcTime start,
                  const std::string& y_label, const Print& print) {
    const Panel above{.y = {y_label}, .height_mm = kStackedPanel_mm},
        below{.x = {hours_after(start)},
              .y = {tr("Temperature (°C)")},
              .height_mm = kStackedPanel_mm};
    return {name, caption, print.wide_mm(), {above, below}};
}

/// Returns the figure of the raw samples' ranges, in steps, of all stretches.
Figure raw_figure(const RecordResult& result, const Print& print) {
    using Range = RecordStretch::RawRange;
    const double reference = reference_of(result);
    const UtcTime start = result.record.stretches.front().times.front();
    std::string acceleration, temperature;
    std::size_t samples = 0;
    for (const RecordStretch& stretch : result.record.stretches) samples += stretch.raw.size();
    const std::size_t each = (samples + kMostSteps - 1) / kMostSteps;
    for (const RecordStretch& stretch : result.record.stretches) {
        for (std::size_t first = 0; first < stretch.raw.size(); first += each) {
            const auto step =
                std::span(stretch.raw).subspan(first, std::min(each, stretch.raw.size() - first));
            const auto limit = [&step](double Range::*member, double (*chosen)(double, double)) {
                double value = step.front().*member;
                for (const Range& range : step) value = chosen(value, range.*member);
                return value;
            };
            const double hours = seconds_between(start, stretch.times[first]) / kSecondsPerHour;
            acceleration += data_line(
                "533", {hours, limit(&Range::acceleration_low_mgal, std::fmin) - reference,
                        limit(&Range::acceleration_high_mgal, std::fmax) - reference});
            temperature += data_line("544", {hours, limit(&Range::temperature_low_degc, std::fmin),
                                             limit(&Range::temperature_high_degc, std::fmax)});
        }
        acceleration += '\n';
        temperature += '\n';
    }
    Figure figure = two_panels("record-raw",
                               tr("Norm and temperature as sampled: range from the least to the "
                                  "greatest sample of each step.") +
                                   as_published("2"),
                               start, above_reference(result), print);
    const std::vector<int> columns{1, 2, 3};
    figure.plot("hours acceleration: least, greatest (mGal)", acceleration,
                {Look::area, Colour::blue, "", columns});
    figure.plot("hours temperature: least, greatest (degC)", temperature,
                {Look::area, Colour::vermilion, "", columns}, 1);
    return figure;
}

Figure samples_figure(const RecordResult& result, const Print& print) {
    const UtcTime start = result.record.stretches.front().times.front();
    const double step_h = step_h_of(result);
    std::string acceleration, temperature;
    for (const long_record::RecordSegment& segment : result.parts.segments) {
        const double first_h = seconds_between(start, segment.start) / kSecondsPerHour;
        acceleration +=
            curve_lines({segment.quantity, step_h, first_h, reference_of(result)}) + '\n';
        temperature += curve_lines({segment.temperature_degc, step_h, first_h}) + '\n';
    }
    Figure figure = two_panels("record-20s",
                               tr("Norm and temperature decimated to 20 s, in the segments that "
                                  "can be analysed.") +
                                   as_published("2"),
                               start, above_reference(result), print);
    figure.plot("hours acceleration_mgal", acceleration, {});
    figure.plot("hours temperature_degc", temperature, {Look::line, Colour::vermilion}, 1);
    return figure;
}

Figure scatter_figure(const std::string& name, const std::string& caption,
                      const std::vector<double>& x, const std::vector<double>& y,
                      const signal::LineFit& fit, double offset, const std::string& y_label,
                      const Print& print) {
    const std::size_t count = std::min(x.size(), y.size());
    std::string points, ends;
    for (std::size_t i = 0; i < count; i += (count + kMostPoints - 1) / kMostPoints)
        points += data_line("64", {x[i], y[i] - offset});
    for (const double at : {std::ranges::min(x), std::ranges::max(x)})
        ends += data_line("64", {at, fit.mean_y + fit.slope * (at - fit.mean_x) - offset});
    const double step = round_step((std::ranges::max(x) - std::ranges::min(x)) / 2.0);
    Figure figure{name,
                  caption,
                  print.small_mm(),
                  {{.x = {.label = tr("Temperature (°C)"), .step = step}, .y = {y_label}}}};
    figure.plot("temperature_degc acceleration_mgal", points, {Look::dots});
    figure.plot(
        "line: temperature_degc acceleration_mgal", ends,
        {Look::strong_line, Colour::vermilion,
         fmt::format("{} mGal/°C, R² = {}", text::fixed(fit.slope, 2), text::fixed(fit.r2, 3))});
    return figure;
}

/// Returns the figure of the acceleration, sign reversed and moved earlier, above the temperature,
/// each with its residue.
Figure trend_figure(const RecordResult& result, const Print& print) {
    const long_record::RecordSegment& segment = result.segment();
    const double step_h = step_h_of(result), moved_h = -result.options.shift_s / kSecondsPerHour;
    const std::vector<double>&a = segment.quantity, &t = segment.temperature_degc;
    Figure figure = two_panels("trend",
                               tr("Acceleration, sign reversed and moved {} s earlier, and "
                                  "temperature, each with the residue of its decomposition.",
                                  text::fixed(result.options.shift_s, 0)) +
                                   as_published("4"),
                               segment.start, tr("- Acceleration (mGal)"), print);
    const std::vector<double>& slow_a = result.analysis.acceleration.residue.values;
    const std::vector<double>& slow_t = result.analysis.temperature.residue.values;
    figure.plot("hours, moved; acceleration, sign reversed (mGal)",
                curve_lines({a, step_h, moved_h, a.front(), -1.0}), {});
    figure.plot("its residue", curve_lines({slow_a, step_h, moved_h, 0.0, -1.0}),
                {Look::strong_line, Colour::black, tr("residue")});
    figure.plot("hours temperature_degc", curve_lines({t, step_h}), {Look::line, Colour::vermilion},
                1);
    figure.plot("its residue", curve_lines({slow_t, step_h}), {Look::strong_line, Colour::black},
                1);
    for (Panel& panel : figure.panels)
        panel.x.range = {moved_h, step_h * static_cast<double>(segment.size())};
    return figure;
}

}  // namespace

Figure tilt_figure(const RecordResult& result, const Print& print) {
    const long_record::TiltFit& tilt = *result.tilt;
    const UtcTime start = result.record.stretches.front().times.front();
    const double step_h = step_h_of(result);
    std::vector<std::vector<double>> corrected;
    double sum = 0.0;
    std::size_t count = 0;
    for (const long_record::RecordSegment& segment : result.parts.segments) {
        std::vector<double>& values = corrected.emplace_back(segment.size());
        for (std::size_t i = 0; i < values.size(); ++i)
            sum += values[i] =
                tilt.corrected_urad(segment.quantity[i], segment.temperature_degc[i]);
        count += values.size();
    }
    const double mean = std::round(sum / static_cast<double>(count));
    std::string measured, without, temperature;
    for (std::size_t k = 0; k < corrected.size(); ++k) {
        const long_record::RecordSegment& segment = result.parts.segments[k];
        const double first_h = seconds_between(start, segment.start) / kSecondsPerHour;
        measured += curve_lines({segment.quantity, step_h, first_h, mean}) + '\n';
        without += curve_lines({corrected[k], step_h, first_h, mean}) + '\n';
        temperature += curve_lines({segment.temperature_degc, step_h, first_h}) + '\n';
    }
    const std::string axis = tilt.axis == 0 ? "x" : "y";
    Figure figure = two_panels(
        "tilt-" + axis,
        tr("Tilt of the axis {}, positive if its positive end rises, as measured and as corrected "
           "to {} °C with {} ± {} µrad/°C; and temperature.",
           axis, text::fixed(tilt.temperature_degc, 3), text::fixed(tilt.slope_urad_per_degc, 2),
           text::fixed(tilt.slope_error_urad_per_degc, 2)),
        start,
        tr("Tilt {} (µrad)",
           mean < 0.0 ? "+ " + text::fixed(-mean, 0) : "- " + text::fixed(mean, 0)),
        print);
    figure.plot("hours tilt_urad", measured, {Look::thin_line, Colour::raw_grey, tr("measured")});
    figure.plot("hours corrected_urad", without, {Look::line, Colour::blue, tr("corrected")});
    figure.plot("hours temperature_degc", temperature, {Look::line, Colour::vermilion}, 1);
    return figure;
}

std::vector<Figure> long_record_figures(const RecordResult& result, const Print& print) {
    const long_record::RecordSegment& segment = result.segment();
    std::vector<Figure> figures;
    if (std::ranges::any_of(result.record.stretches,
                            [](const RecordStretch& one) { return !one.raw.empty(); }))
        figures.push_back(raw_figure(result, print));
    figures.push_back(samples_figure(result, print));
    figures.push_back(trend_figure(result, print));
    figures.push_back(decomposition_figure(result, print));
    if (result.analysis.modes) {
        const ModePair pair = mode_pair(result);
        figures.push_back(overlay_figure(result, pair, print));
        figures.push_back(scatter_figure(
            "scatter-modes",
            tr("The two modes, acceleration sign reversed and moved, with regression line.") +
                as_published("6", is_published_pair(result) ? published_line(result, "mode") : ""),
            pair.temperature, pair.turned, result.analysis.modes->moved, 0.0,
            tr("- Acceleration (mGal)"), print));
        figures.push_back(correlation_figure(result, print));
    }
    figures.push_back(scatter_figure("scatter",
                                     tr("All samples at 20 s, with regression line.") +
                                         as_published("3", published_line(result, "raw")),
                                     segment.temperature_degc, segment.quantity,
                                     result.analysis.raw, reference_of(result),
                                     above_reference(result), print));
    return figures;
}

}  // namespace a351::corrector::figure
