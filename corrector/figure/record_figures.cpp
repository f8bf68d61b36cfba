#include "corrector/figure/record_figures.hpp"

#include <algorithm>
#include <cmath>

#include "corrector/eemd/extrema.hpp"
#include "corrector/figure/escaping.hpp"
#include "corrector/figure/reading_name.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {
namespace {

double minutes_between(UtcTime from, UtcTime to) { return seconds_between(from, to) / 60.0; }

std::string figure_name(std::size_t row) {
    const std::string number = std::to_string(row + 1);
    return "reading-" + std::string(number.size() < 2 ? 1 : 0, '0') + number;
}

/// Returns the index of the series' sample at which the trend begins.
std::size_t curve_begin(const RepresentativeValue& value) {
    const double seconds = seconds_between(value.series.start(), value.curve.start());
    return static_cast<std::size_t>(std::llround(seconds * value.series.rate().value()));
}

double at_or_nan(const std::vector<double>& values, std::size_t i) {
    return i < values.size() ? values[i] : std::nan("");
}

std::string series_lines(const RepresentativeValue& value) {
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

std::string extremum_lines(const RepresentativeValue& value) {
    std::string lines;
    for (const std::size_t i : extremum_indices(value.curve.values())) {
        const UtcTime time = value.curve.time_of(static_cast<double>(i));
        lines += datum(minutes_between(value.series.start(), time), 4) +
                 datum(value.curve.values()[i], 3) + '\n';
    }
    return lines;
}

/// Returns the limits of the interval, with the values of the trend there.
std::string limit_lines(const RepresentativeValue& value) {
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

/// Returns a text on the part of the record that was averaged.
std::string averaged_text(const CorrectedRow& row, double mean_mgal) {
    if (!row.day) return "mean over the interval " + text::fixed(mean_mgal, 3) + " mGal.";
    return "the model day averages " + text::fixed(row.day->averaged_s, 0) + " s of it to " +
           text::fixed(row.row.acceleration.value(), 3) +
           " mGal; trend and interval apply to the other models.";
}

Figure reading_figure(const SurveyCorrection& result, const ReadingRecord& record) {
    const RepresentativeValue& value = *record.value;
    const std::string name = figure_name(record.row);
    const std::string file = "'" + name + ".dat'";
    DataBlocks data;
    data.add("minutes acceleration_mgal trend_mgal temperature_degc", series_lines(value));
    const auto limits = data.add("limits of the interval: minutes trend_mgal", limit_lines(value));
    const auto extrema =
        data.add("extrema of the trend: minutes trend_mgal", extremum_lines(value));

    const double mean_mgal = value.acceleration.value();
    const double half_mgal = std::max(half_range(spread(value.series.values(), mean_mgal, 0.98)),
                                      1.1 * spread(value.curve.values(), mean_mgal, 1.0));
    std::vector<std::string> clauses{
        file + " index 0 using 1:($2-mean) with lines lw 0.7 lc rgb '#aaaaaa' title '2 s series'",
        file + " index 0 using 1:($3-mean) with lines lw 2 lc rgb " + kBlue + " title 'trend'"};
    if (extrema) {
        clauses.push_back(file + " index " + std::to_string(*extrema) +
                          " using 1:($2-mean) with points pt 12 ps 0.6 lc rgb " + kBlue +
                          " title 'extrema'");
    }
    clauses.push_back(file + " index " + std::to_string(limits.value()) +
                      " using 1:($2-mean) with points pt 13 ps 0.7 lc rgb " + kVermilion +
                      " title 'interval'");
    std::string lines;
    for (const UtcTime limit : {value.interval_start, value.interval_end}) {
        const std::string x = text::fixed(minutes_between(value.series.start(), limit), 4);
        lines.append("set arrow from first ").append(x).append(",graph 0 to first ").append(x);
        lines.append(",graph 1 nohead dt 2 lw 1 lc rgb ").append(kVermilion).append("\n");
    }
    const std::string reading = reading_name(result.rows, record.row);
    return Figure{
        name,
        reading + ", from " + to_rfc3339(value.series.start()) + ": " +
            averaged_text(result.rows[record.row], mean_mgal),
        script_head(name, 480, 300) + "mean = " + text::fixed(mean_mgal, 3) + '\n' + "set title " +
            gnuplot_string(reading) + "\nset xlabel 'Minutes'\nset ylabel " +
            gnuplot_string("Acceleration - " + text::fixed(mean_mgal, 1) + " (mGal)") +
            "\nset yrange [" + text::fixed(-half_mgal, 3) + ":" + text::fixed(half_mgal, 3) +
            "]\nset ytics " + text::fixed(round_step(half_mgal / 1.3), 4) + "\nset xrange [0:" +
            text::fixed(
                minutes_between(value.series.start(),
                                value.series.time_of(static_cast<double>(value.series.size()))),
                3) +
            "]\nset key tmargin center horizontal samplen 1.5 font ',11'\n" + lines +
            plot_command(clauses) + script_tail(),
        data.text(), true};
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
    return text::fixed(-last, 5) + ',' + text::fixed(step, 5) + ',' + text::fixed(last, 5);
}

std::string panels_script(const SurveyCorrection& result, const std::vector<ReadingRecord>& records,
                          const Panels& panels) {
    constexpr std::size_t kColumns = 5;
    const std::size_t n = records.size();
    const std::size_t lines = (n + kColumns - 1) / kColumns;
    double longest_min = 0.0;
    for (const ReadingRecord& record : records) {
        const auto& series = record.value->series;
        longest_min = std::max(
            longest_min,
            minutes_between(series.start(), series.time_of(static_cast<double>(series.size()))));
    }
    const int height_px = 70 + 120 * static_cast<int>(lines);
    // Margins for the labels, in pixels, as fractions of the height.
    const std::string bottom = text::fixed(52.0 / height_px, 4);
    const std::string top = text::fixed(1.0 - 12.0 / height_px, 4);
    const std::string gap = text::fixed(10.0 / height_px, 4);
    std::string script =
        script_head(panels.name, 960, height_px) + "set multiplot layout " + std::to_string(lines) +
        "," + std::to_string(kColumns) + " margins screen 0.07,0.99," + bottom + "," + top +
        " spacing screen 0.012," + gap + "\nset xrange [0:" + text::fixed(longest_min, 2) +
        "]\nset yrange [" + text::fixed(-panels.half, 5) + ":" + text::fixed(panels.half, 5) +
        "]\nset xtics " + text::fixed(round_step(longest_min / 2.5), 4) + "\nset ytics " +
        inner_tics(panels.half) + "\nunset key\nset label 1 'Minutes' at screen 0.53," +
        text::fixed(14.0 / height_px, 4) + " center\nset label 2 '" + panels.y_label +
        "' at screen 0.014,0.53 center rotate by 90\n";
    for (std::size_t k = 0; k < n; ++k) {
        const bool is_lowest = k + kColumns >= n;
        script += std::string("set format x '") + (is_lowest ? "%g" : "") + "'\nset format y '" +
                  (k % kColumns == 0 ? "%g" : "") + "'\nset label 3 " +
                  gnuplot_string(short_label(reading_name(result.rows, records[k].row))) +
                  " at graph 0.04,0.9 font ',11' front\nset label 4 " +
                  gnuplot_string("mean " + text::fixed(panels.means[k], panels.label_decimals)) +
                  " at graph 0.96,0.09 right font ',10' front\nplot '" +
                  figure_name(records[k].row) + ".dat' index 0 using 1:($" + panels.column + "-" +
                  text::fixed(panels.means[k], 5) + ") with lines " + panels.style + '\n';
        if (k == 0) script += "unset label 1\nunset label 2\n";
    }
    return script + "unset multiplot\n" + script_tail();
}

}  // namespace

std::vector<ReadingRecord> find_records(const SurveyCorrection& result,
                                        const std::vector<RepresentativeValue>& values) {
    std::vector<ReadingRecord> records;
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const SurveyRow& row = result.rows[i].row;
        const auto found =
            std::find_if(values.begin(), values.end(), [&row](const RepresentativeValue& value) {
                return row.start && row.end && *row.start < value.interval_end &&
                       value.interval_start < *row.end;
            });
        if (found != values.end()) records.push_back({i, &*found});
    }
    return records;
}

std::vector<Figure> reading_figures(const SurveyCorrection& result,
                                    const std::vector<ReadingRecord>& records) {
    std::vector<Figure> figures;
    figures.reserve(records.size());
    for (const ReadingRecord& record : records) figures.push_back(reading_figure(result, record));
    return figures;
}

std::vector<Figure> panel_figures(const SurveyCorrection& result,
                                  const std::vector<ReadingRecord>& records) {
    if (records.empty()) return {};
    Panels acceleration{"records-acceleration",
                        "Acceleration of every reading: samples of 2 s minus the value of the "
                        "reading; one scale for all, knocks are cut off.",
                        "Acceleration - mean (mGal)",
                        "2",
                        "lw 0.7 lc rgb " + kBlue,
                        0.0,
                        {},
                        1};
    Panels temperature{"records-temperature",
                       "Temperature of every reading: samples of 2 s minus the temperature of the "
                       "reading; one scale for all.",
                       "Temperature - mean (°C)",
                       "4",
                       "lw 0.9 lc rgb " + kVermilion,
                       0.0,
                       {},
                       3};
    for (const ReadingRecord& record : records) {
        const RepresentativeValue& value = *record.value;
        const SurveyRow& row = result.rows[record.row].row;
        acceleration.means.push_back(row.acceleration.value());
        temperature.means.push_back(row.temperature.value());
        acceleration.half =
            std::max(acceleration.half,
                     half_range(spread(value.series.values(), row.acceleration.value(), 0.98)));
        temperature.half = std::max(
            temperature.half,
            half_range(spread(value.temperature_series.values(), row.temperature.value(), 0.98)));
    }
    std::vector<Figure> figures;
    for (const Panels& panels : {acceleration, temperature}) {
        figures.push_back(
            {panels.name, panels.caption, panels_script(result, records, panels), {}});
    }
    return figures;
}

}  // namespace a351::corrector
