#include "corrector/figure/long_record_figures.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "protocol/core/units.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {
namespace {

/// Most steps of a curve.  Reason: two to three per pixel.
constexpr std::size_t kMostSteps = 1500;
/// Length of the figure with both modes, h.  Reason: in a longer one the curves cannot be
/// distinguished.
constexpr double kOverlay_h = 12.0;

/// Returns the least and the greatest value of every step; one value if a step is one sample.
std::string curve_lines(const std::vector<double>& values, double first_h, double step_h,
                        double offset, double factor) {
    const std::size_t each = (values.size() + kMostSteps - 1) / kMostSteps;
    std::string lines;
    for (std::size_t first = 0; first < values.size(); first += each) {
        const std::size_t behind = std::min(values.size(), first + each);
        const auto [low, high] =
            std::minmax_element(values.begin() + static_cast<std::ptrdiff_t>(first),
                                values.begin() + static_cast<std::ptrdiff_t>(behind));
        const std::string x =
            datum(first_h + step_h * 0.5 * static_cast<double>(first + behind - 1), 5);
        lines += x + datum(factor * (*low - offset), 5) + '\n';
        if (each > 1) lines += x + datum(factor * (*high - offset), 5) + '\n';
    }
    return lines;
}

std::string scatter_lines(const std::vector<double>& x, const std::vector<double>& y,
                          double offset) {
    const std::size_t count = std::min(x.size(), y.size());
    const std::size_t each = (count + kMostPoints - 1) / kMostPoints;
    std::string lines;
    for (std::size_t i = 0; i < count; i += each)
        lines += datum(x[i], 6) + datum(y[i] - offset, 4) + '\n';
    return lines;
}

std::string line_lines(const std::vector<double>& x, const correlation::LineFit& fit,
                       double offset) {
    const auto [low, high] = std::minmax_element(x.begin(), x.end());
    std::string lines;
    for (const double at : {*low, *high})
        lines +=
            datum(at, 6) + datum(fit.mean_y + fit.slope * (at - fit.mean_x) - offset, 4) + '\n';
    return lines;
}

/// Returns the mean acceleration rounded to whole mGal, so that the axis is easy to read.
double reference_of(const long_record::RecordResult& result) {
    return std::round(correlation::mean_of(result.segment().acceleration_mgal));
}

std::string above(double reference) {
    return fmt::format("set ylabel '{}'\n",
                       text::tr("Acceleration - {} (mGal)", text::fixed(reference, 0)));
}

std::string hours_axis(UtcTime start) {
    return fmt::format("set xlabel '{}'\n", text::tr("Hours after {}", to_rfc3339(start)));
}

/// Returns the figure of the acceleration above the temperature.
/// @param head  commands before the upper panel.
Figure two_panels(const FigureData& data, const std::string& caption, const std::string& head,
                  const std::vector<std::string>& accelerations, UtcTime start,
                  const std::vector<std::string>& temperatures) {
    return data.figure(caption, 900, 480,
                       fmt::format("set multiplot layout 2,1\nset lmargin 12\n{}{}"
                                   "set ylabel '{}'\n{}{}unset multiplot\n",
                                   head, plot_command(accelerations), text::tr("Temperature (°C)"),
                                   hours_axis(start), plot_command(temperatures)));
}

/// Returns the figure of the raw samples' ranges, in steps, of all stretches.
Figure raw_figure(const long_record::RecordResult& result, double reference) {
    const UtcTime start = result.record.stretches.front().times.front();
    std::string acceleration, temperature;
    std::size_t samples = 0;
    for (const long_record::RecordStretch& stretch : result.record.stretches)
        samples += stretch.raw.size();
    const std::size_t each = (samples + kMostSteps - 1) / kMostSteps;
    for (const long_record::RecordStretch& stretch : result.record.stretches) {
        for (std::size_t first = 0; first < stretch.raw.size(); first += each) {
            long_record::RecordStretch::RawRange range = stretch.raw[first];
            for (std::size_t i = first; i < std::min(stretch.raw.size(), first + each); ++i) {
                const long_record::RecordStretch::RawRange& next = stretch.raw[i];
                range.acceleration_low_mgal =
                    std::fmin(range.acceleration_low_mgal, next.acceleration_low_mgal);
                range.acceleration_high_mgal =
                    std::fmax(range.acceleration_high_mgal, next.acceleration_high_mgal);
                range.temperature_low_degc =
                    std::fmin(range.temperature_low_degc, next.temperature_low_degc);
                range.temperature_high_degc =
                    std::fmax(range.temperature_high_degc, next.temperature_high_degc);
            }
            const std::string x =
                datum(seconds_between(start, stretch.times[first]) / kSecondsPerHour, 5);
            acceleration += x + datum(range.acceleration_low_mgal - reference, 3) +
                            datum(range.acceleration_high_mgal - reference, 3) + '\n';
            temperature += x + datum(range.temperature_low_degc, 4) +
                           datum(range.temperature_high_degc, 4) + '\n';
        }
        acceleration += '\n';
        temperature += '\n';
    }
    FigureData data("record-raw");
    const std::string style = " using 1:2:3 with filledcurves lc rgb ";
    const std::string a =
        data.add("hours acceleration: least, greatest (mGal)", acceleration) + style + kBlue;
    const std::string t =
        data.add("hours temperature: least, greatest (degC)", temperature) + style + kVermilion;
    return two_panels(
        data,
        text::tr("Norm and temperature as sampled: range from the least to the greatest "
                 "sample of each step."),
        above(reference), {a + " notitle"}, start, {t + " notitle"});
}

Figure samples_figure(const long_record::RecordResult& result, double reference) {
    const UtcTime start = result.record.stretches.front().times.front();
    std::string acceleration, temperature;
    for (const long_record::RecordSegment& segment : result.parts.segments) {
        const double first_h = seconds_between(start, segment.start) / kSecondsPerHour;
        const double step_h = result.record.step_s / kSecondsPerHour;
        acceleration +=
            curve_lines(segment.acceleration_mgal, first_h, step_h, reference, 1.0) + '\n';
        temperature += curve_lines(segment.temperature_degc, first_h, step_h, 0.0, 1.0) + '\n';
    }
    FigureData data("record-20s");
    const std::string style = " using 1:2 with lines lc rgb ";
    const std::string a = data.add("hours acceleration_mgal", acceleration) + style + kBlue;
    const std::string t = data.add("hours temperature_degc", temperature) + style + kVermilion;
    return two_panels(
        data,
        text::tr("Norm and temperature decimated to 20 s, in the segments that can be analysed."),
        above(reference), {a + " notitle"}, start, {t + " notitle"});
}

Figure scatter_figure(const std::string& name, const std::string& caption,
                      const std::vector<double>& x, const std::vector<double>& y,
                      const correlation::LineFit& fit, double offset, const std::string& ylabel) {
    FigureData data(name);
    const std::string points =
        data.add("temperature_degc acceleration_mgal", scatter_lines(x, y, offset));
    const std::string line =
        data.add("line: temperature_degc acceleration_mgal", line_lines(x, fit, offset));
    return data.figure(
        caption, 480, 400,
        fmt::format(
            "set xlabel '{}'\n{}set xtics rotate by -30\nset rmargin 5\n{}",
            text::tr("Temperature (°C)"), ylabel,
            plot_command(
                {fmt::format("{} using 1:2 with points pt 7 ps 0.2 lc rgb {} notitle", points,
                             kBlue),
                 fmt::format("{} using 1:2 with lines lw 1.5 lc rgb {} title '{} mGal/°C, R² = {}'",
                             line, kVermilion, text::fixed(fit.slope, 2),
                             text::fixed(fit.r2, 3))})));
}

/// Returns the figure of the acceleration, sign reversed and moved earlier, above the temperature,
/// each with its residue.
Figure trend_figure(const long_record::RecordResult& result) {
    const long_record::RecordSegment& segment = result.segment();
    const double step_h = result.record.step_s / kSecondsPerHour;
    const double moved_h = -result.options.shift_s / kSecondsPerHour;
    const double first = segment.acceleration_mgal.front();
    const std::vector<double>& slow = result.analysis.acceleration.residue.values;
    FigureData data("trend");
    const std::string a =
        data.add("hours, moved; acceleration, sign reversed (mGal)",
                 curve_lines(segment.acceleration_mgal, moved_h, step_h, first, -1.0));
    const std::string a_slow =
        data.add("its residue", curve_lines(slow, moved_h, step_h, 0.0, -1.0));
    const std::string t = data.add("hours temperature_degc",
                                   curve_lines(segment.temperature_degc, 0.0, step_h, 0.0, 1.0));
    const std::string t_slow =
        data.add("its residue",
                 curve_lines(result.analysis.temperature.residue.values, 0.0, step_h, 0.0, 1.0));
    const std::string line = " using 1:2 with lines lc rgb ",
                      thick = " using 1:2 with lines lw 2.5 lc rgb 'black' ";
    return two_panels(
        data,
        text::tr("Acceleration, sign reversed and moved {} s earlier, and temperature, each "
                 "with the residue of its decomposition.",
                 text::fixed(result.options.shift_s, 0)),
        fmt::format("set xrange [{}:{}]\nset ylabel '{}'\n", text::fixed(moved_h, 3),
                    text::fixed(step_h * static_cast<double>(segment.size()), 3),
                    text::tr("- Acceleration (mGal)")),
        {a + line + kBlue + " notitle", a_slow + thick + "title '" + text::tr("residue") + "'"},
        segment.start, {t + line + kVermilion + " notitle", t_slow + thick + "notitle"});
}

struct ModePair {
    std::vector<double> temperature;
    std::vector<double> turned;  ///< Acceleration, sign reversed, moved earlier by the shift.
};

ModePair mode_pair(const long_record::RecordResult& result) {
    const long_record::RecordAnalysis& analysis = result.analysis;
    const std::vector<double>& a =
        analysis.acceleration.modes[analysis.acceleration_mode->number - 1].values;
    const auto earlier =
        static_cast<std::size_t>(std::llround(result.options.shift_s / result.record.step_s));
    ModePair pair;
    pair.temperature = analysis.temperature.modes[analysis.temperature_mode->number - 1].values;
    for (std::size_t i = earlier; i < a.size(); ++i) pair.turned.push_back(-a[i]);
    pair.temperature.resize(pair.turned.size());
    return pair;
}

Figure overlay_figure(const long_record::RecordResult& result, const ModePair& pair) {
    const double step_h = result.record.step_s / kSecondsPerHour;
    const std::size_t count =
        std::min(pair.turned.size(), static_cast<std::size_t>(kOverlay_h / step_h));
    const auto first = static_cast<std::ptrdiff_t>((pair.turned.size() - count) / 2);
    const auto part = [&](const std::vector<double>& values) {
        return std::vector<double>(values.begin() + first,
                                   values.begin() + first + static_cast<std::ptrdiff_t>(count));
    };
    const double first_h = static_cast<double>(first) * step_h;
    FigureData data("modes");
    const std::string a = data.add("hours; acceleration, sign reversed and moved (mGal)",
                                   curve_lines(part(pair.turned), first_h, step_h, 0.0, 1.0));
    const std::string t = data.add("hours temperature_degc",
                                   curve_lines(part(pair.temperature), first_h, step_h, 0.0, 1.0));
    return data.figure(
        text::tr("Modes of the cycle: acceleration, sign reversed and moved {} s earlier, and "
                 "temperature{}.",
                 text::fixed(result.options.shift_s, 0),
                 count < pair.turned.size() ? text::tr("; the middle of the record") : ""),
        900, 360,
        fmt::format(
            "{}set ylabel '{}'\nset y2label '{}'\n"
            "set ytics nomirror\nset y2tics\n{}",
            hours_axis(result.segment().start), text::tr("- Acceleration (mGal)"),
            text::tr("Temperature (°C)"),
            plot_command({fmt::format("{} using 1:2 with lines lc rgb {} title '{}'", a, kBlue,
                                      text::tr("acceleration, sign reversed and moved")),
                          fmt::format("{} using 1:2 axes x1y2 with lines lc rgb {} title '{}'", t,
                                      kVermilion, text::tr("temperature"))})));
}

Figure correlation_figure(const long_record::RecordResult& result) {
    const auto lines = [](const correlation::CrossCorrelation& correlation) {
        std::string text;
        for (std::size_t i = 0; i < correlation.values.size(); ++i)
            text += datum(correlation.delays_s[i], 1) + datum(correlation.values[i], 5) + '\n';
        return text;
    };
    FigureData data("correlation");
    const std::string modes =
        data.add("modes: delay_s correlation", lines(result.analysis.modes->correlation));
    const std::string band =
        data.add("band: delay_s correlation", lines(result.analysis.band.correlation));
    const std::string style = " using 1:2 with lines lw 1.5 lc rgb ";
    return data.figure(
        text::tr("Cross-correlation of the two modes, and of the band, against the delay of the "
                 "acceleration."),
        480, 400,
        fmt::format("set xlabel '{}'\nset ylabel '{}'\nset yrange [-1:1]\nset xzeroaxis\n",
                    text::tr("Delay of the acceleration (s)"), text::tr("Correlation")) +
            plot_command({modes + style + kBlue + " title '" + text::tr("modes") + "'",
                          band + style + kGrey + " title '" + text::tr("band") + "'"}));
}

}  // namespace

std::vector<Figure> long_record_figures(const long_record::RecordResult& result) {
    const double reference = reference_of(result);
    const long_record::RecordSegment& segment = result.segment();
    std::vector<Figure> figures;
    const auto& stretches = result.record.stretches;
    if (std::ranges::any_of(stretches, [](const long_record::RecordStretch& stretch) {
            return !stretch.raw.empty();
        })) {
        figures.push_back(raw_figure(result, reference));
    }
    figures.push_back(samples_figure(result, reference));
    figures.push_back(trend_figure(result));
    if (result.analysis.modes) {
        const ModePair pair = mode_pair(result);
        figures.push_back(overlay_figure(result, pair));
        figures.push_back(scatter_figure(
            "scatter-modes",
            text::tr("The two modes, acceleration sign reversed and moved, with regression line."),
            pair.temperature, pair.turned, result.analysis.modes->moved, 0.0,
            fmt::format("set ylabel '{}'\n", text::tr("- Acceleration (mGal)"))));
        figures.push_back(correlation_figure(result));
    }
    figures.push_back(scatter_figure(
        "scatter", text::tr("All samples at 20 s, with regression line."), segment.temperature_degc,
        segment.acceleration_mgal, result.analysis.raw, reference, above(reference)));
    return figures;
}

}  // namespace a351::corrector::figure
