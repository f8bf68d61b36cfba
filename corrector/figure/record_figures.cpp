#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "corrector/eemd/extrema.hpp"
#include "corrector/figure/escaping.hpp"
#include "corrector/figure/record_figures.hpp"
#include "corrector/judgement/reading_name.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {
namespace {

double minutes_between(UtcTime from, UtcTime to) { return seconds_between(from, to) / 60.0; }

double length_min(const reading::RepresentativeValue& value) {
    const auto end = value.series.time_of(static_cast<double>(value.series.size()));
    return minutes_between(value.series.start(), end);
}

/// Returns the index of the series' sample at which the trend begins.
std::size_t curve_begin(const reading::RepresentativeValue& value) {
    const double seconds = seconds_between(value.series.start(), value.curve.start());
    return static_cast<std::size_t>(std::llround(seconds * value.series.rate().value()));
}

double at_or_nan(const std::vector<double>& values, std::size_t i) {
    return i < values.size() ? values[i] : std::nan("");
}

std::string series_lines(const reading::RepresentativeValue& value) {
    const std::size_t begin = curve_begin(value);
    std::string lines;
    for (std::size_t i = 0; i < value.series.size(); ++i) {
        const UtcTime time = value.series.time_of(static_cast<double>(i));
        lines += datum(minutes_between(value.series.start(), time), 4) +
                 datum(value.series.values()[i], 3) +
                 datum(i < begin ? std::nan("") : at_or_nan(value.curve.values(), i - begin), 3) +
                 datum(at_or_nan(value.temperature_series.values(), i), 5) + '\n';
    }
    return lines;
}

std::string extremum_lines(const reading::RepresentativeValue& value) {
    std::string lines;
    for (const std::size_t i : eemd::extremum_indices(value.curve.values())) {
        const UtcTime time = value.curve.time_of(static_cast<double>(i));
        lines += datum(minutes_between(value.series.start(), time), 4) +
                 datum(value.curve.values()[i], 3) + '\n';
    }
    return lines;
}

/// Returns the limits of the interval, with the values of the trend there.
std::string limit_lines(const reading::RepresentativeValue& value) {
    std::string lines;
    for (const UtcTime limit : {value.interval_start, value.interval_end}) {
        const double place = seconds_between(value.curve.start(), limit);
        const auto i = static_cast<std::size_t>(std::llround(place * value.curve.rate().value()));
        lines += datum(minutes_between(value.series.start(), limit), 4) +
                 datum(at_or_nan(value.curve.values(), i), 3) + '\n';
    }
    return lines;
}

/// Returns the distance from `centre` within which `share` of the finite values are; 0 without any.
double spread(const std::vector<double>& values, double centre, double share) {
    std::vector<double> distances;
    for (const double value : values) {
        if (std::isfinite(value)) distances.push_back(std::abs(value - centre));
    }
    if (distances.empty()) return 0.0;
    const auto place =
        static_cast<std::ptrdiff_t>(share * static_cast<double>(distances.size() - 1));
    std::nth_element(distances.begin(), distances.begin() + place, distances.end());
    return distances[static_cast<std::size_t>(place)];
}

/// Returns half the range of an axis, not zero: a fifth more than 98 of 100 samples need, so that a
/// knock does not flatten the rest.
double half_range(double spread_of_98) { return std::max(1.2 * spread_of_98, 1e-3); }

/// Returns a text on the part of the record that was averaged, with its standard error.
std::string averaged_text(const model::CorrectedRow& row, double mean_mgal) {
    const auto* const day = row.as<model::WholeDayRow>();
    const auto error = row.row.record ? row.row.record->standard_error : std::nullopt;
    const std::string samples =
        error ? text::tr("; standard error from the scatter of the samples alone {} mGal",
                         text::fixed(error->value(), 2))
              : "";
    if (day == nullptr)
        return text::tr("mean over the interval {} mGal{}.", text::fixed(mean_mgal, 3), samples);
    return text::tr(
        "the model day averages {} s of it, mean {} mGal{}. Only the other models use the trend "
        "and the interval shown.",
        text::fixed(day->averaged_s, 0), text::fixed(row.row.measured().value(), 3), samples);
}

Figure reading_figure(const model::SurveyCorrection& result, const ReadingRecord& record) {
    const reading::RepresentativeValue& value = *record.value;
    FigureData data(reading_figure_name(record.row));
    const std::string series =
        data.add("minutes acceleration_mgal trend_mgal temperature_degc", series_lines(value));
    const std::string limits =
        data.add("limits of the interval: minutes trend_mgal", limit_lines(value));
    const std::string extrema =
        data.add("extrema of the trend: minutes trend_mgal", extremum_lines(value));

    const double mean_mgal = value.curve_mean.value();
    const double half_mgal = std::max(half_range(spread(value.series.values(), mean_mgal, 0.98)),
                                      1.1 * spread(value.curve.values(), mean_mgal, 1.0));
    std::vector<std::string> clauses{
        series + " using 1:($2-mean) with lines lw 0.7 lc rgb '#aaaaaa' title '2 s series'",
        series + " using 1:($3-mean) with lines lw 2 lc rgb " + kBlue + " title 'trend'"};
    if (!extrema.empty()) {
        clauses.push_back(extrema + " using 1:($2-mean) with points pt 12 ps 0.6 lc rgb " + kBlue +
                          " title 'extrema'");
    }
    clauses.push_back(limits + " using 1:($2-mean) with points pt 13 ps 0.7 lc rgb " + kVermilion +
                      " title 'interval'");
    std::string lines;
    for (const UtcTime limit : {value.interval_start, value.interval_end}) {
        lines += fmt::format(
            "set arrow from first {0},graph 0 to first {0},graph 1 nohead dt 2 lw 1 lc rgb {1}\n",
            text::fixed(minutes_between(value.series.start(), limit), 4), kVermilion);
    }
    const std::string reading = judgement::reading_name(result.rows, record.row);
    return data.figure(
        text::tr("{}, from {}: {}", reading, to_rfc3339(value.series.start()),
                 averaged_text(result.rows[record.row], mean_mgal)),
        480, 300,
        fmt::format("mean = {}\nset title {}\nset xlabel '{}'\nset ylabel {}\nset yrange [{}:{}]\n"
                    "set ytics {}\nset xrange [0:{}]\n"
                    "set key tmargin center horizontal samplen 1.5 font ',11'\n{}{}",
                    text::fixed(mean_mgal, 3), gnuplot_string(reading), text::tr("Minutes"),
                    gnuplot_string(text::tr("Acceleration - {} (mGal)", text::fixed(mean_mgal, 1))),
                    text::fixed(-half_mgal, 3), text::fixed(half_mgal, 3),
                    text::fixed(round_step(half_mgal / 1.3), 4), text::fixed(length_min(value), 3),
                    lines, plot_command(clauses)));
}

/// Contents of a figure with one panel per record.
struct Panels {
    std::string name, caption, y_label;
    std::string column;  ///< Column of the readings' data.
    std::string style;
    double half = 0.0;  ///< Half the range about the panel's mean.
    std::vector<double> means;
    int label_decimals = 0;
};

/// Returns ticks from -half to half, without those whose labels would touch the labels of the next
/// panel.
std::string inner_tics(double half) {
    const double step = round_step(half / 1.3);
    const double last = step * std::floor(0.85 * half / step);
    return fmt::format("{},{},{}", text::fixed(-last, 5), text::fixed(step, 5),
                       text::fixed(last, 5));
}

Figure panels_figure(const model::SurveyCorrection& result,
                     const std::vector<ReadingRecord>& records, const Panels& panels) {
    constexpr std::size_t kColumns = 5;
    const std::size_t n = records.size();
    const std::size_t lines = (n + kColumns - 1) / kColumns;
    double longest_min = 0.0;
    for (const ReadingRecord& record : records)
        longest_min = std::max(longest_min, length_min(*record.value));
    const int height_px = 70 + 120 * static_cast<int>(lines);
    // Margins for the labels, in pixels, as a fraction of the height.
    const auto share = [height_px](double px) { return px / height_px; };
    std::string script = fmt::format(
        "set multiplot layout {},{} margins screen 0.07,0.99,{},{} spacing screen 0.012,{}\n"
        "set xrange [0:{}]\nset yrange [{}:{}]\nset xtics {}\nset ytics {}\nunset key\n"
        "set label 1 'Minutes' at screen 0.53,{} center\n"
        "set label 2 '{}' at screen 0.014,0.53 center rotate by 90\n",
        lines, kColumns, text::fixed(share(52.0), 4), text::fixed(1.0 - share(12.0), 4),
        text::fixed(share(10.0), 4), text::fixed(longest_min, 2), text::fixed(-panels.half, 5),
        text::fixed(panels.half, 5), text::fixed(round_step(longest_min / 2.5), 4),
        inner_tics(panels.half), text::fixed(share(14.0), 4), panels.y_label);
    for (std::size_t k = 0; k < n; ++k) {
        script += fmt::format(
            "set format x '{}'\nset format y '{}'\n"
            "set label 3 {} at graph 0.04,0.9 font ',11' front\n"
            "set label 4 {} at graph 0.96,0.09 right font ',10' front\n"
            "plot '{}.dat' index 0 using 1:(${}-{}) with lines {}\n",
            k + kColumns >= n ? "%g" : "", k % kColumns == 0 ? "%g" : "",
            gnuplot_string(short_label(judgement::reading_name(result.rows, records[k].row))),
            gnuplot_string("mean " + text::fixed(panels.means[k], panels.label_decimals)),
            reading_figure_name(records[k].row), panels.column, text::fixed(panels.means[k], 5),
            panels.style);
        if (k == 0) script += "unset label 1\nunset label 2\n";
    }
    return FigureData(panels.name)
        .figure(panels.caption, 960, height_px, script + "unset multiplot\n");
}

}  // namespace

std::string reading_figure_name(std::size_t row) { return fmt::format("reading-{:02}", row + 1); }

double half_range_of_samples(const model::SurveyCorrection& result,
                             const std::vector<ReadingRecord>& records) {
    double half_mgal = 0.0;
    for (const ReadingRecord& record : records)
        half_mgal = std::max(
            half_mgal, half_range(spread(record.value->series.values(),
                                         result.rows[record.row].row.measured().value(), 0.98)));
    return half_mgal;
}

std::vector<ReadingRecord> find_records(const model::SurveyCorrection& result,
                                        const std::vector<reading::RepresentativeValue>& values) {
    std::vector<ReadingRecord> records;
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const reading::SurveyRow& row = result.rows[i].row;
        const auto found =
            std::ranges::find_if(values, [&row](const reading::RepresentativeValue& value) {
                return row.start && row.end && *row.start < value.interval_end &&
                       value.interval_start < *row.end;
            });
        if (found != values.end()) records.push_back({i, &*found});
    }
    return records;
}

std::vector<Figure> reading_figures(const model::SurveyCorrection& result,
                                    const std::vector<ReadingRecord>& records) {
    std::vector<Figure> figures;
    for (const ReadingRecord& record : records) figures.push_back(reading_figure(result, record));
    return figures;
}

std::vector<Figure> panel_figures(const model::SurveyCorrection& result,
                                  const std::vector<ReadingRecord>& records) {
    if (records.empty()) return {};
    Panels acceleration{
        "records-acceleration",
        text::tr("Acceleration of every reading: samples of 2 s minus the value of the "
                 "reading. All panels have the same scale, which cuts off knocks."),
        text::tr("Acceleration - mean (mGal)"),
        "2",
        "lw 0.7 lc rgb " + kBlue,
        half_range_of_samples(result, records),
        {},
        1};
    Panels temperature{
        "records-temperature",
        text::tr("Temperature of every reading: samples of 2 s minus the temperature of the "
                 "reading. All panels have the same scale."),
        text::tr("Temperature - mean (°C)"),
        "4",
        "lw 0.9 lc rgb " + kVermilion,
        0.0,
        {},
        3};
    for (const ReadingRecord& record : records) {
        const reading::RepresentativeValue& value = *record.value;
        const reading::SurveyRow& row = result.rows[record.row].row;
        acceleration.means.push_back(row.measured().value());
        temperature.means.push_back(row.temperature.value());
        temperature.half = std::max(
            temperature.half,
            half_range(spread(value.temperature_series.values(), row.temperature.value(), 0.98)));
    }
    return {panels_figure(result, records, acceleration),
            panels_figure(result, records, temperature)};
}

}  // namespace a351::corrector::figure
