#include <cmath>

#include "corrector/figure/long_record_figures.hpp"
#include "corrector/figure/record_curve.hpp"
#include "corrector/figure/survey_figures.hpp"
#include "corrector/noise/earth_noise.hpp"
#include "corrector/noise/spectral_density.hpp"
#include "corrector/reading/disturbance.hpp"
#include "protocol/core/units.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {
namespace {

using long_record::RecordResult;
using text::tr;

/// Returns the figure of a spectrum with its limits, the models of the ground and, if it is known, the
/// noise of the data sheet.
Figure density_figure(const std::string& name, const std::string& caption,
                      const std::vector<noise::Density>& spectrum,
                      const std::optional<double>& data_sheet_mgal_per_sqrt_hz, double width_mm) {
    Figure figure{name, caption, width_mm};
    figure.panels = {
        {{.label = tr("Frequency (Hz)"),
          .range = {0.9 * spectrum.front().frequency_hz, 1.1 * spectrum.back().frequency_hz},
          .scale = Scale::logarithmic},
         {.label = tr("Acceleration (mGal/√Hz)"), .format = "%g", .scale = Scale::logarithmic}}};
    std::string measured, low, high;
    for (const noise::Density& one : spectrum) {
        const double f = one.frequency_hz;
        measured +=
            data_line("9666", {f, std::sqrt(one.mgal2_per_hz.value),
                               std::sqrt(one.mgal2_per_hz.low), std::sqrt(one.mgal2_per_hz.high)});
        low +=
            data_line("99", {f, ground_noise_mgal_per_sqrt_hz(noise::GroundNoise::low, 1.0 / f)});
        high +=
            data_line("99", {f, ground_noise_mgal_per_sqrt_hz(noise::GroundNoise::high, 1.0 / f)});
    }
    const std::string source = figure.add("frequency_hz mgal_per_sqrt_hz low high", measured);
    figure.panels[0].series = {{Look::area, Colour::limits, "", {1, 3, 4}, source},
                               {Look::line, Colour::blue, tr("record"), {1, 2}, source}};
    figure.plot("NHNM: frequency_hz mgal_per_sqrt_hz", high,
                {Look::dashed_line, Colour::black, "NHNM"});
    figure.plot("NLNM: frequency_hz mgal_per_sqrt_hz", low,
                {Look::dotted_line, Colour::grey, "NLNM"});
    if (data_sheet_mgal_per_sqrt_hz) {
        std::string line;
        for (const noise::Density* end : {&spectrum.front(), &spectrum.back()})
            line += data_line("96", {end->frequency_hz, *data_sheet_mgal_per_sqrt_hz});
        figure.plot("data sheet: frequency_hz mgal_per_sqrt_hz", line,
                    {Look::thin_line, Colour::black, tr("data sheet")});
    }
    return figure;
}

Figure spectrum_figure(const RecordResult& result, const Print& print) {
    const noise::RecordNoise& noise = result.analysis.noise;
    Figure figure = density_figure(
        "noise-spectrum",
        tr("Amplitude spectral density of the acceleration with 95 % limits, the three "
           "noises of the Allan deviation, the ground at the quietest and noisiest "
           "seismic stations (Peterson 1993), and the noise of the sensor by its data "
           "sheet, which is for faster signals."),
        noise.spectrum, result.record.data_sheet_mgal_per_sqrt_hz, print.wide_mm());
    std::string model;
    for (const noise::Density& one : noise.spectrum)
        model +=
            data_line("96", {one.frequency_hz,
                             std::sqrt(noise.allan.noises.density_mgal2_per_hz(one.frequency_hz))});
    figure.plot("three noises: frequency_hz mgal_per_sqrt_hz", model,
                {Look::strong_line, Colour::vermilion, tr("three noises")});
    return figure;
}

Figure allan_noise_figure(const std::string& name, const std::string& part,
                          const noise::AllanAnalysis& analysis, const Print& print) {
    Figure figure{name,
                  tr("Allan deviation of the acceleration{}, with 95 % limits if the three noises "
                     "describe it, and that of white noise, flicker and random walk together.",
                     part),
                  print.small_mm()};
    const auto& allan = analysis.points;
    const Axis time{.label = tr("Averaging time (s)"),
                    .range = {0.8 * allan.front().averaging_s, 1.25 * allan.back().averaging_s},
                    .scale = Scale::logarithmic};
    figure.panels = {{time, {.label = tr("Allan deviation (mGal)"), .scale = Scale::logarithmic}}};
    std::string points, model;
    for (const noise::AllanPoint& point : allan) {
        points += data_line("0666", {point.averaging_s, point.deviation_mgal.value,
                                     point.deviation_mgal.low, point.deviation_mgal.high});
        model += data_line("06", {point.averaging_s, point.model_mgal});
    }
    figure.plot("averaging_s deviation_mgal", model,
                {Look::strong_line, Colour::vermilion, tr("three noises")});
    figure.plot("averaging_s deviation_mgal low high", points,
                analysis.noises.describes_record
                    ? Series{Look::discs_with_bars, Colour::blue, tr("record"), {1, 2, 3, 4}}
                    : Series{Look::discs, Colour::blue, tr("record")});
    return figure;
}

Figure spectrogram_figure(const RecordResult& result, const Print& print) {
    const std::vector<noise::Tile> tiles =
        noise::spectrogram(result.segment().quantity, result.record.step_s);
    Figure figure{"noise-spectrogram",
                  tr("Spectral density of the acceleration by hour, each of two hours about it, in "
                     "bands of a quarter octave or one frequency."),
                  print.wide_mm()};
    if (tiles.empty()) return figure;
    Panel& panel = figure.panels.emplace_back();
    panel.x = {
        .label = hours_after(result.segment().start),
        .range = {tiles.front().start_s / kSecondsPerHour, tiles.back().end_s / kSecondsPerHour}};
    panel.y = {.label = tr("Frequency (Hz)"),
               .range = {tiles.front().low_hz, tiles.back().high_hz},
               .format = "%g",
               .scale = Scale::logarithmic};
    panel.colours = {
        .label = tr("Acceleration (mGal/√Hz)"), .format = "%g", .scale = Scale::logarithmic};
    std::string lines;
    for (const noise::Tile& tile : tiles) {
        const double from_h = tile.start_s / kSecondsPerHour, to_h = tile.end_s / kSecondsPerHour;
        lines += data_line(
            "4848886", {0.5 * (from_h + to_h), std::sqrt(tile.low_hz * tile.high_hz), from_h, to_h,
                        tile.low_hz, tile.high_hz, std::sqrt(tile.mgal2_per_hz)});
    }
    figure.plot("hours frequency_hz from_h to_h low_hz high_hz mgal_per_sqrt_hz", lines,
                {Look::tiles, Colour::by_value, "", {1, 2, 3, 4, 5, 6, 7}});
    return figure;
}

}  // namespace

std::vector<Figure> quiet_noise_figures(const model::SurveyCorrection& result,
                                        const std::vector<ReadingRecord>& records,
                                        const std::optional<double>& data_sheet_mgal_per_sqrt_hz,
                                        const Print& print) {
    // 4 min of samples of 2 s: five segments in a stay of 12 min.
    constexpr std::size_t kLength = 120;
    std::vector<std::vector<double>> parts;
    double step_s = 0.0, samples = 0.0;
    for (const ReadingRecord& record : records) {
        if (!result.rows[record.row].is_used) continue;
        const auto& series = record.value->series;
        step_s = 1.0 / series.rate().value();
        for (auto& part :
             reading::quiet_parts(series.values(), reading::kDisturbanceThreshold, kLength)) {
            samples += static_cast<double>(part.size());
            parts.push_back(std::move(part));
        }
    }
    const std::vector<noise::Density> spectrum = noise::pooled_density(parts, step_s, kLength);
    if (spectrum.empty()) return {};
    const noise::AllanAnalysis allan = noise::pooled_allan(parts, step_s);
    return {
        density_figure(
            "noise-day",
            tr("Amplitude spectral density of the acceleration in the quiet parts of the stays "
               "that are used in the fit, together, with 95 % limits: {} min in {} parts without "
               "motion, each in segments of {} min; the ground at the quietest and noisiest "
               "seismic stations (Peterson 1993); and the noise of the sensor by its data sheet, "
               "which is for faster signals.",
               text::fixed(samples * step_s / 60.0, 0), parts.size(),
               text::fixed(static_cast<double>(kLength) * step_s / 60.0, 0)),
            spectrum, data_sheet_mgal_per_sqrt_hz, print.small_mm()),
        allan_noise_figure(
            "noise-day-allan",
            tr(" in the quiet parts of the stays that are used in the fit, together"), allan,
            print)};
}

std::vector<Figure> noise_figures(const RecordResult& result, const Print& print) {
    std::vector<Figure> figures{
        spectrum_figure(result, print),
        allan_noise_figure("noise-allan", "", result.analysis.noise.allan, print),
        spectrogram_figure(result, print)};
    std::erase_if(figures, [](const Figure& figure) { return figure.panels.empty(); });
    return figures;
}

}  // namespace a351::corrector::figure
