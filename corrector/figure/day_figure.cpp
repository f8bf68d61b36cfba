#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>

#include "corrector/figure/escaping.hpp"
#include "corrector/figure/layout.hpp"
#include "corrector/figure/record_figures.hpp"
#include "corrector/figure/row_marks.hpp"
#include "corrector/judgement/reading_grade.hpp"
#include "protocol/core/units.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {
namespace {

using text::tr;

/// The time from the start of a stay to its end, with its site.
struct Stay {
    UtcTime start, end;
    std::string name;
    Colour colour = Colour::stay;
};

/// Returns the stays with a value, whose set-ups are one band, then those without.  Without records
/// a stay is an instant.
std::vector<Stay> stays_of(const model::SurveyCorrection& result,
                           const std::vector<ReadingRecord>& records) {
    std::vector<Stay> stays;
    auto record = records.begin();
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const reading::SurveyRow& row = result.rows[i].row;
        Stay stay{row.first_instant(), row.last_instant(), short_label(row.site)};
        if (record != records.end() && record->row == i) {
            const auto& series = record->value->series;
            stay.start = std::min(stay.start, series.start());
            stay.end = std::max(stay.end, series.time_of(static_cast<double>(series.size())));
            ++record;
        }
        if (i > 0 && reading::is_same_stay(result.rows[i - 1].row, row))  // a further set-up
            stays.back().end = stay.end;
        else
            stays.push_back(stay);
    }
    for (const reading::LeftOut& stay : result.left_out)
        stays.push_back({stay.start, stay.end, short_label(stay.site), Colour::lost_stay});
    return stays;
}

std::string caption_of(const model::SurveyCorrection& result, bool has_records, bool has_course,
                       bool has_signal) {
    const std::string errors =
        result.as<model::WholeDayPart>() != nullptr
            ? tr("The day. Above: value of the reading if its station is left out, minus reference "
                 "(cross-validated); bars: standard uncertainty u of this value.")
        : result.as<model::NetworkPart>() != nullptr
            ? tr("The day. Above: residuals, corrected value minus reference (in sample); bars: "
                 "standard uncertainty u of a single reading, a priori.")
            : tr("The day. Above: residuals, corrected value minus reference (in sample); bars: "
                 "standard uncertainty u as of a new station, from the scatter in sample.");
    return errors +
           (has_records ? tr(" Middle: samples of 2 s minus the mean of the reading; the scale "
                             "cuts off knocks.")
                        : "") +
           (has_course ? tr(" Below: temperature of the sensor and of the readings.")
                       : tr(" Below: temperature of the readings.")) +
           (has_signal ? tr(" Band: signal of the recorder, from the event log.") : "") +
           tr(" Shaded: stays (grey), averaged intervals (blue), stays without a value (red).");
}

/// Adds the errors of the readings to the first panel, if a row has a reference.
void plot_errors(Figure& figure, const model::SurveyCorrection& result) {
    plot_rows(
        figure, result, "time_utc error_mgal u_corrected_mgal",
        [](const model::CorrectedRow& row) -> std::string {
            const auto error_mgal = judgement::error_of(row);
            if (!error_mgal) return {};
            const double u_mgal = row.u_corrected.value_or(MilliGal(0.0)).value();
            return to_rfc3339(row.row.time) + ' ' + data_line("44", {*error_mgal, u_mgal}, "");
        });
    std::vector<Series>& series = figure.panels.front().series;
    if (series.empty()) return;
    add_bars(figure.panels.front());
    series.insert(series.begin(), {.look = Look::line, .colour = Colour::grey, .source = kZero});
}

/// Adds the samples of the records, which are in the data of their own figures.
void plot_samples(Panel& panel, const model::SurveyCorrection& result,
                  const std::vector<ReadingRecord>& records) {
    if (records.empty()) return;
    const double half_mgal = half_range_of(result, records, false);
    panel.y.range = {-half_mgal, half_mgal};
    for (const ReadingRecord& record : records)
        panel.series.push_back({Look::thin_line,
                                Colour::blue,
                                "",
                                {5, 2},  // time and acceleration, minus that of the reading
                                source_of(reading_figure_name(record.row), 0)});
}

void plot_temperatures(Figure& figure, const model::SurveyCorrection& result,
                       const std::vector<archive_series::MinuteTemperature>& course) {
    std::string course_lines, reading_lines;
    for (std::size_t i = 0; i < course.size(); ++i) {
        const bool is_gap =
            i > 0 && course[i].middle - course[i - 1].middle > std::chrono::minutes(1);
        course_lines += (is_gap ? "\n" : "") + to_rfc3339(course[i].middle) + ' ' +
                        data_line("4", {course[i].mean.value()});
    }
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const reading::SurveyRow& row = result.rows[i].row;
        if (row.has_temperature)
            reading_lines += to_rfc3339(row.time) + ' ' +
                             data_line("4", {row.temperature.value()}, comment(result, i));
    }
    figure.plot("means of a minute: time_utc temperature_degc", course_lines,
                {Look::line, Colour::vermilion}, 2);
    figure.plot("readings: time_utc temperature_degc", reading_lines, {Look::small_discs}, 2);
}

/// Adds the signal as a band, with its words as key.  Each word has its own height, so that words
/// can be distinguished in grey.
void plot_signal(Figure& figure, const std::vector<reading::SignalSpan>& signal) {
    struct Word {
        const char* code;
        const char* text;
        Colour colour;
    };
    constexpr std::array<Word, 6> kWords{{{"go", text::marked("YOU CAN GO"), Colour::green},
                                          {"keep_off", text::marked("KEEP OFF"), Colour::orange},
                                          {"lift", text::marked("LIFT, SET DOWN"), Colour::blue},
                                          {"look", text::marked("LOOK"), Colour::vermilion},
                                          {"warming_up", text::marked("WARMING UP"), Colour::sky},
                                          {"no_data", text::marked("NO DATA"), Colour::grey}}};
    double height = 1.0;
    for (const auto& [word, name, colour] : kWords) {
        std::string lines;
        height -= 1.0 / static_cast<double>(kWords.size() + 1);
        for (const reading::SignalSpan& span : signal)
            if (span.word == word)
                lines += fmt::format("{0} {1:.2f}\n{2} {1:.2f}\n\n", to_rfc3339(span.start), height,
                                     to_rfc3339(span.end));
        figure.plot(fmt::format("signal {}: time_utc height", word), lines,
                    {Look::ribbon, colour, text::translated(name)}, 3);
    }
}

/// Returns the axis from the first to the last instant, with a margin.
Axis time_axis(UtcTime first, UtcTime last, const Print& print) {
    // Longest survey whose axis shows only hours; a longer one needs the date too.
    constexpr std::chrono::hours kLongestDay(36);
    const std::string first_date = to_rfc3339(first).substr(0, 10);
    const std::string last_date = to_rfc3339(last).substr(0, 10);
    const auto margin = (last - first) / 50 + std::chrono::minutes(1);
    // Whole hours, so that their numbers have room.
    const double hours = seconds_between(first, last) / kSecondsPerHour;
    const double most = print.is_narrow() ? 7.0 : 14.0;
    double step_h = 1.0;
    for (const double longer : {2.0, 3.0, 6.0, 12.0, 24.0, 48.0, 96.0})
        if (hours / step_h > most) step_h = longer;
    return {.label = fmt::format("UTC, {}{}", first_date,
                                 first_date == last_date ? "" : " to " + last_date),
            .range = {instant(first - margin), instant(last + margin)},
            .step = step_h * kSecondsPerHour,
            .format = last - first > kLongestDay ? "%H:%M\n%m-%d" : "%H:%M",
            .scale = Scale::time};
}

}  // namespace

Figure day_figure(const model::SurveyCorrection& result, const std::vector<ReadingRecord>& records,
                  const std::vector<archive_series::MinuteTemperature>& course,
                  const std::vector<reading::SignalSpan>& signal, const Print& print) {
    const std::vector<Stay> stays = stays_of(result, records);
    UtcTime first = stays.front().start, last = first;
    std::vector<Span> spans;
    std::vector<std::pair<double, std::string>> names;
    for (const Stay& stay : stays) {
        first = std::min(first, stay.start);
        last = std::max(last, stay.end);
        spans.push_back({instant(stay.start), instant(stay.end), stay.colour});
        names.emplace_back(0.5 * (instant(stay.start) + instant(stay.end)), stay.name);
    }
    std::ranges::stable_sort(names, {}, &std::pair<double, std::string>::first);
    for (const model::CorrectedRow& row : result.rows)
        if (row.row.start && row.row.end)
            spans.push_back({instant(*row.row.start), instant(*row.row.end), Colour::averaged});

    Figure figure{"day",
                  caption_of(result, !records.empty(), !course.empty(), !signal.empty()),
                  print.wide_mm(),
                  {{.y = {.label = tr("Value - reference (mGal)")}, .height_mm = kStackedPanel_mm},
                   {.y = {tr("Samples - mean (mGal)")}, .height_mm = kStackedPanel_mm},
                   {.y = {tr("Temperature (°C)")}, .height_mm = kStackedPanel_mm},
                   {.y = {.label = tr("Signal"), .range = {0.0, 1.0}, .is_shown = false},
                    .height_mm = 12.0}}};
    plot_errors(figure, result);
    plot_samples(figure.panels.at(1), result, records);
    plot_temperatures(figure, result, course);
    plot_signal(figure, signal);
    std::erase_if(figure.panels, [](const Panel& panel) { return panel.series.empty(); });
    for (Panel& panel : figure.panels) {
        panel.x = time_axis(first, last, print);
        panel.spans = spans;
    }
    if (figure.panels.empty()) return figure;
    figure.panels.front().names = names;
    const std::vector<double> places = layout_of(figure).panels.front().names;
    std::vector<std::string> left_out;
    for (std::size_t k = 0; k < names.size(); ++k)
        if (std::isnan(places[k])) left_out.push_back(names[k].second);
    figure.caption += without_room(left_out);
    return figure;
}

std::optional<Figure> faces_figure(const model::SurveyCorrection& result, const Print& print) {
    struct Both {
        std::array<double, 2> sum_mgal{}, count{};  ///< In the faces + and -.
        Nanoseconds after{};                        ///< Sum of the times since the first row.
    };
    std::map<std::pair<std::string, int>, Both> stays;
    const UtcTime first = result.rows.front().row.time, last = result.rows.back().row.time;
    for (const model::CorrectedRow& one : result.rows) {
        Both& stay = stays[{one.row.site, one.row.occupation}];
        const std::size_t face = one.row.face < 0 ? 1U : 0U;
        stay.sum_mgal.at(face) += one.row.reduced().value();
        stay.count.at(face) += 1.0;
        stay.after += one.row.time - first;
    }
    struct Half {
        std::string time;
        double difference_mgal;
        std::string end;
    };
    std::vector<Half> halves;
    std::string sums;
    double mean_mgal = 0.0;
    for (const auto& [name, stay] : stays) {
        if (stay.count[0] == 0.0 || stay.count[1] == 0.0) continue;
        const double up_mgal = stay.sum_mgal[0] / stay.count[0],
                     down_mgal = stay.sum_mgal[1] / stay.count[1];
        const auto set_ups = static_cast<Nanoseconds::rep>(stay.count[0] + stay.count[1]);
        const std::string time = to_rfc3339(first + stay.after / set_ups) + ' ',
                          end = "# " + clean_utf8(name.first) + '\n';
        halves.push_back({time, 0.5 * (up_mgal - down_mgal), end});
        mean_mgal += halves.back().difference_mgal;
        if (const auto* const station = result.station(name.first))
            sums += time +
                    data_line("4", {0.5 * (up_mgal + down_mgal) - station->gravity.value()}, end);
    }
    if (halves.empty()) return std::nullopt;
    mean_mgal /= static_cast<double>(halves.size());
    std::string differences;
    for (const auto& [time, half_mgal, end] : halves)
        differences += time + data_line("4", {half_mgal - mean_mgal}, end);
    Figure figure{
        "faces",
        tr("Both faces of the sensor, a point for each stay. Above: half the difference of the "
           "readings in the faces + and -, minus the day's mean of {} mGal; this is the bias, with "
           "drift and temperature. Below: half their sum minus the gravity found for the station; "
           "what is left is of the scale, placement and noise. Figures of readings that are not "
           "corrected are left out, because they show twice the bias between the faces.",
           text::fixed(mean_mgal, 1)),
        print.wide_mm(),
        {{.y = {.label = tr("Half difference - mean (mGal)")},
          .has_margin = true,
          .height_mm = kStackedPanel_mm},
         {.y = {.label = tr("Half sum - gravity (mGal)")},
          .has_margin = true,
          .height_mm = kStackedPanel_mm}}};
    figure.plot("stays: time_utc half_difference_minus_mean_mgal", differences, {Look::discs});
    figure.plot("stays: time_utc half_sum_minus_gravity_mgal", sums,
                {Look::triangles, Colour::vermilion}, 1);
    std::erase_if(figure.panels, [](const Panel& panel) { return panel.series.empty(); });
    for (Panel& panel : figure.panels) {
        panel.series.insert(panel.series.begin(),
                            {.look = Look::line, .colour = Colour::grey, .source = kZero});
        panel.x = time_axis(first, last, print);
    }
    return figure;
}

}  // namespace a351::corrector::figure
