#include "corrector/figure/record_figures.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "corrector/eemd/extrema.hpp"
#include "corrector/figure/escaping.hpp"
#include "corrector/judgement/reading_name.hpp"
#include "corrector/result/columns.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {
namespace {

using reading::RepresentativeValue;
using text::fixed, text::tr;

double minutes_in(const RepresentativeValue& value, UtcTime time) {
    return seconds_between(value.series.start(), time) / 60.0;
}

double length_min(const RepresentativeValue& value) {
    return minutes_in(value, value.series.time_of(static_cast<double>(value.series.size())));
}

double at_or_nan(const std::vector<double>& values, long long i) {
    return i >= 0 && i < std::ssize(values) ? values[static_cast<std::size_t>(i)] : std::nan("");
}

double trend_at(const RepresentativeValue& value, UtcTime time) {
    const double place = seconds_between(value.curve.start(), time) * value.curve.rate().value();
    return at_or_nan(value.curve.values(), std::llround(place));
}

/// Returns the samples minus the values of the reading.
std::string series_lines(const RepresentativeValue& value, const reading::SurveyRow& row) {
    const double mean_mgal = row.measured().value(), mean_degc = row.temperature.value();
    std::string lines;
    for (std::size_t i = 0; i < value.series.size(); ++i) {
        const UtcTime time = value.series.time_of(static_cast<double>(i));
        const auto index = static_cast<long long>(i);
        lines += data_line("4335",
                           {minutes_in(value, time), value.series.values()[i] - mean_mgal,
                            trend_at(value, time) - mean_mgal,
                            at_or_nan(value.temperature_series.values(), index) - mean_degc},
                           to_rfc3339(time, 3) + '\n');
    }
    return lines;
}

/// Returns instants with the values of the trend there, minus that of the reading.
std::string trend_lines(const RepresentativeValue& value, double mean_mgal,
                        const std::vector<UtcTime>& times) {
    std::string lines;
    for (const UtcTime time : times)
        lines += data_line("43", {minutes_in(value, time), trend_at(value, time) - mean_mgal});
    return lines;
}

/// Returns the distance from `centre` within which `share` of the finite values are; 0 without any.
double spread(const std::vector<double>& values, double centre, double share) {
    std::vector<double> distances;
    for (const double value : values)
        if (std::isfinite(value)) distances.push_back(std::abs(value - centre));
    if (distances.empty()) return 0.0;
    const auto place =
        static_cast<std::ptrdiff_t>(share * static_cast<double>(distances.size() - 1));
    std::nth_element(distances.begin(), distances.begin() + place, distances.end());
    return distances[static_cast<std::size_t>(place)];
}

/// Returns half the range of an axis, not zero: 1.7 times what nine of ten samples need, 2.8 standard
/// deviations of noise, so that a knock of a minute does not flatten the rest.
double half_range(const std::vector<double>& values, double centre) {
    return std::max(1.7 * spread(values, centre, 0.9), 1e-3);
}

/// Returns the axis of both directions.
Axis axis_about_zero(const std::string& label, double half) {
    return {.label = label, .range = {-half, half}, .step = round_step(half)};
}

/// Returns a text on the part of the record that was averaged, with its standard error.
std::string averaged_text(const model::CorrectedRow& row, double mean_mgal) {
    const auto* const day = row.as<model::WholeDayRow>();
    const auto error = row.row.record ? row.row.record->standard_error : std::nullopt;
    const std::string samples =
        error ? tr("; standard error from the scatter of the samples alone {} mGal",
                   fixed(error->value(), 2))
              : "";
    if (day == nullptr)
        return tr("mean over the interval {} mGal{}.", fixed(mean_mgal, 3), samples);
    return tr(
        "the model day averages {} s of it, mean {} mGal{}. Only the other models use the "
        "trend and the interval shown.",
        fixed(day->averaged_s, 0), fixed(row.row.measured().value(), 3), samples);
}

Figure reading_figure(const model::SurveyCorrection& result, const ReadingRecord& record,
                      const Print& print) {
    const RepresentativeValue& value = *record.value;
    const reading::SurveyRow& row = result.rows[record.row].row;
    const double mean_mgal = row.measured().value();
    const double half_mgal = std::max(half_range(value.series.values(), mean_mgal),
                                      1.1 * spread(value.curve.values(), mean_mgal, 1.0));
    const std::string reading = judgement::reading_name(result.rows, record.row);
    Figure figure{reading_figure_name(record.row),
                  tr("{}, from {}: {}", reading, to_rfc3339(value.series.start()),
                     averaged_text(result.rows[record.row], value.curve_mean.value())) +
                      as_published("11"),
                  print.small_mm()};
    Panel& panel = figure.panels.emplace_back();
    const double used_min = result::used_minutes(result.rows[record.row]).value_or(0.0);
    panel.note = tr("{}, {} of {} min", short_label(reading), fixed(used_min, 1),
                    fixed(length_min(value), 1));
    panel.spans = {{minutes_in(value, *row.start), minutes_in(value, *row.end), Colour::averaged}};
    panel.height_mm = kStackedPanel_mm;
    panel.x = {.label = tr("Minutes"), .range = {0.0, length_min(value)}};
    panel.y = axis_about_zero(tr("Acceleration - {} (mGal)", fixed(mean_mgal, 1)), half_mgal);
    std::vector<UtcTime> extrema;
    for (const std::size_t i : eemd::extremum_indices(value.curve.values()))
        extrema.push_back(value.curve.time_of(static_cast<double>(i)));
    const std::vector<UtcTime> limits{value.interval_start, value.interval_end};
    for (const UtcTime limit : limits) {
        const double x = minutes_in(value, limit);
        panel.lines.push_back({{x, 0.0, true}, {x, 1.0, true}});
    }
    const std::string means =
        fmt::format("minus {:.3f} mGal and {:.5f} degC", mean_mgal, row.temperature.value());
    const std::string series =
        figure.add(means + ": minutes acceleration_mgal trend_mgal temperature_degc time_utc",
                   series_lines(value, row));
    panel.series = {{Look::thin_line, Colour::raw_grey, "2 s series", {1, 2}, series},
                    {Look::strong_line, Colour::blue, "trend", {1, 3}, series}};
    const std::string ends = figure.add("limits of the interval: minutes trend_mgal",
                                        trend_lines(value, mean_mgal, limits));
    figure.plot("extrema of the trend: minutes trend_mgal", trend_lines(value, mean_mgal, extrema),
                {Look::open_diamonds, Colour::blue, "extrema"});
    panel.series.push_back({Look::diamonds, Colour::vermilion, "interval", {1, 2}, ends});
    return figure;
}

/// Returns the value about which a record is drawn.
double centre_of(const model::SurveyCorrection& result, const ReadingRecord& record,
                 bool is_temperature) {
    const reading::SurveyRow& row = result.rows[record.row].row;
    return is_temperature ? row.temperature.value() : row.measured().value();
}

}  // namespace

std::string reading_figure_name(std::size_t row) { return fmt::format("reading-{:02}", row + 1); }

double half_range_of(const model::SurveyCorrection& result,
                     const std::vector<ReadingRecord>& records, bool is_temperature) {
    double half = 0.0;
    for (const ReadingRecord& record : records)
        half = std::max(half, half_range(is_temperature ? record.value->temperature_series.values()
                                                        : record.value->series.values(),
                                         centre_of(result, record, is_temperature)));
    return half;
}

std::vector<ReadingRecord> find_records(const model::SurveyCorrection& result,
                                        const std::vector<RepresentativeValue>& values) {
    std::vector<ReadingRecord> records;
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const reading::SurveyRow& row = result.rows[i].row;
        const auto found = std::ranges::find_if(values, [&row](const RepresentativeValue& value) {
            return row.start && row.end && *row.start < value.interval_end &&
                   value.interval_start < *row.end;
        });
        if (found != values.end()) records.push_back({i, &*found});
    }
    return records;
}

std::vector<Figure> reading_figures(const model::SurveyCorrection& result,
                                    const std::vector<ReadingRecord>& records, const Print& print) {
    std::vector<Figure> figures;
    for (const ReadingRecord& record : records)
        figures.push_back(reading_figure(result, record, print));
    return figures;
}

std::vector<Figure> panel_figures(const model::SurveyCorrection& result,
                                  const std::vector<ReadingRecord>& records, const Print& print) {
    if (records.empty()) return {};
    double longest_min = 0.0;
    for (const ReadingRecord& record : records)
        longest_min = std::max(longest_min, length_min(*record.value));
    const Axis minutes{.label = tr("Minutes"),
                       .range = {0.0, longest_min},
                       .step = round_step(longest_min / 2.0),
                       .format = "%g"};
    std::vector<Figure> figures{
        {"records-acceleration",
         tr("Acceleration of every reading: samples of 2 s minus the value of the reading, which "
            "is "
            "above each panel. All panels have the same scale, which cuts off knocks.") +
             as_published("10")},
        {"records-temperature",
         tr("Temperature of every reading: samples of 2 s minus the temperature of the reading, "
            "which is above each panel. All panels have the same scale.")}};
    for (const bool is_temperature : {false, true}) {
        Figure& figure = figures.at(is_temperature ? 1 : 0);
        figure.width_mm = print.wide_mm();
        figure.columns = print.is_narrow() ? 2 : 4;
        Axis y = axis_about_zero(
            is_temperature ? tr("Temperature - mean (°C)") : tr("Acceleration - mean (mGal)"),
            half_range_of(result, records, is_temperature));
        y.format = minutes.format;
        for (const ReadingRecord& record : records) {
            const double centre = centre_of(result, record, is_temperature);
            const Series samples{is_temperature ? Look::line : Look::thin_line,
                                 is_temperature ? Colour::vermilion : Colour::blue,
                                 "",
                                 {1, is_temperature ? 4 : 2},
                                 source_of(reading_figure_name(record.row), 0)};
            Panel& panel = figure.panels.emplace_back(Panel{minutes, y, {samples}});
            panel.height_mm = print.is_narrow() ? 15.0 : 18.0;
            panel.heading = short_label(judgement::reading_name(result.rows, record.row));
            panel.note = fixed(centre, is_temperature ? 3 : 1);
        }
    }
    return figures;
}

}  // namespace a351::corrector::figure
