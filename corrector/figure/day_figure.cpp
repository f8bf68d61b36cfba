#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "corrector/figure/escaping.hpp"
#include "corrector/figure/record_figures.hpp"
#include "corrector/figure/row_marks.hpp"
#include "corrector/judgement/reading_grade.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {
namespace {

/// A part of the figure with an axis of its own; all have the axis of time in common.
struct Panel {
    int height_px = 0;
    std::string y_label;
    std::string commands;
    std::vector<std::string> clauses;
};

/// The time from the start of a stay to its end, with its name.
struct Band {
    UtcTime start, end;
    std::string name;
};

/// Returns the stays with a value; its set-ups are one band.  Without records a stay is an instant.
std::vector<Band> stays_of(const model::SurveyCorrection& result,
                           const std::vector<ReadingRecord>& records) {
    std::vector<Band> stays;
    auto record = records.begin();
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const reading::SurveyRow& row = result.rows[i].row;
        Band band{row.start.value_or(row.time), row.end.value_or(row.time),
                  fmt::format("{} ({})", short_label(row.site), row.occupation)};
        if (record != records.end() && record->row == i) {
            const auto& series = record->value->series;
            band.start = std::min(band.start, series.start());
            band.end = std::max(band.end, series.time_of(static_cast<double>(series.size())));
            ++record;
        }
        const bool is_further_set_up = i > 0 && result.rows[i - 1].row.site == row.site &&
                                       result.rows[i - 1].row.occupation == row.occupation;
        if (is_further_set_up) {
            stays.back().end = band.end;
        } else {
            stays.push_back(band);
        }
    }
    return stays;
}

std::vector<Band> lost_stays_of(const model::SurveyCorrection& result) {
    std::vector<Band> stays;
    for (const reading::LeftOut& stay : result.left_out)
        stays.push_back({stay.start, stay.end,
                         fmt::format("{} ({})", short_label(stay.site), stay.occupation)});
    return stays;
}

std::string shading(UtcTime start, UtcTime end, const std::string& colour) {
    return fmt::format(
        "set object rectangle from '{}',graph 0 to '{}',graph 1 fc rgb {} fs solid noborder "
        "behind\n",
        to_rfc3339(start), to_rfc3339(end), colour);
}

std::string error_lines(const model::SurveyCorrection& result, const Mark& mark) {
    std::string lines;
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const model::CorrectedRow& row = result.rows[i];
        const auto error_mgal = judgement::error_of(row);
        if (!error_mgal || !mark.takes(row)) continue;
        lines += fmt::format("{} {}{}{}", to_rfc3339(row.row.time), datum(*error_mgal, 4),
                             datum(row.u_corrected ? row.u_corrected->value() : 0.0, 4),
                             comment(result, i));
    }
    return lines;
}

/// Returns the errors of the readings; no clauses if no row has a reference.
Panel error_panel(const model::SurveyCorrection& result, FigureData& data) {
    Panel panel{210, text::tr("Reference - value (mGal)"), "", {}};
    for (const Mark& mark : marks()) {
        const std::string source = data.add(mark.title + ": time_utc error_mgal u_corrected_mgal",
                                            error_lines(result, mark));
        if (source.empty()) continue;
        panel.clauses.push_back(
            source + " using 1:2:3 with yerrorbars pt 0 lw 0.8 lc rgb '#999999' notitle");
        panel.clauses.push_back(fmt::format("{} using 1:2 with points {} title '{}'", source,
                                            mark.style,
                                            text::translated(mark.title, text::language())));
    }
    if (!panel.clauses.empty())
        panel.clauses.insert(panel.clauses.begin(),
                             "0 with lines lw 1 lc rgb " + kGrey + " notitle");
    return panel;
}

/// Returns the samples of the records, which are in the data of their own figures.
Panel sample_panel(const model::SurveyCorrection& result,
                   const std::vector<ReadingRecord>& records) {
    if (records.empty()) return {};
    const std::string half = text::fixed(half_range_of_samples(result, records), 3);
    Panel panel{
        150, text::tr("Samples - mean (mGal)"), fmt::format("set yrange [-{0}:{0}]\n", half), {}};
    for (const ReadingRecord& record : records)
        panel.clauses.push_back(fmt::format(
            "'{}.dat' index 0 using ({}+60*$1):($2-{}) with lines lw 0.7 lc rgb {} notitle",
            reading_figure_name(record.row),
            text::fixed(seconds_between(UtcTime{}, record.value->series.start()), 3),
            text::fixed(result.rows[record.row].row.measured().value(), 3), kBlue));
    return panel;
}

Panel temperature_panel(const model::SurveyCorrection& result,
                        const std::vector<reading::MinuteTemperature>& course, FigureData& data) {
    std::string course_lines, reading_lines;
    for (std::size_t i = 0; i < course.size(); ++i) {
        const bool is_gap =
            i > 0 && course[i].middle - course[i - 1].middle > std::chrono::minutes(1);
        course_lines += fmt::format("{}{} {}\n", is_gap ? "\n" : "", to_rfc3339(course[i].middle),
                                    datum(course[i].mean.value(), 4));
    }
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const reading::SurveyRow& row = result.rows[i].row;
        if (!row.has_temperature) continue;
        reading_lines += fmt::format("{} {}{}", to_rfc3339(row.time),
                                     datum(row.temperature.value(), 4), comment(result, i));
    }
    Panel panel{170, text::tr("Temperature (°C)"), "set yrange [*:*]\n", {}};
    const std::string means =
        data.add("means of a minute: time_utc temperature_degc", course_lines);
    if (!means.empty())
        panel.clauses.push_back(means + " using 1:2 with lines lw 1.2 lc rgb " + kVermilion +
                                " notitle");
    if (!reading_lines.empty())
        panel.clauses.push_back(data.add("readings: time_utc temperature_degc", reading_lines) +
                                " using 1:2 with points pt 7 ps 0.5 lc rgb " + kBlue + " notitle");
    return panel;
}

/// Returns the verdicts as a band, with their words as key.
Panel verdict_panel(const std::vector<reading::VerdictSpan>& verdicts, FigureData& data) {
    struct State {
        const char *word, *colour;
    };
    constexpr std::array kStates{
        State{text::marked("stable"), "#009E73"}, State{text::marked("settling"), "#E69F00"},
        State{text::marked("disturbed"), "#D55E00"}, State{text::marked("warming up"), "#56B4E9"},
        State{text::marked("no data"), "#888888"}};
    Panel panel{46,
                "",
                "set yrange [0:1]\nunset ytics\nset key inside left top horizontal maxrows 1 "
                "samplen 1.5\n",
                {}};
    for (const State& state : kStates) {
        std::string lines;
        for (const reading::VerdictSpan& span : verdicts)
            if (span.state == state.word)
                lines += fmt::format("{} 0.25\n{} 0.25\n\n", to_rfc3339(span.start),
                                     to_rfc3339(span.end));
        const std::string source =
            data.add(fmt::format("verdict {}: time_utc height", state.word), lines);
        if (!source.empty())
            panel.clauses.push_back(
                fmt::format("{} using 1:2 with lines lw 9 lc rgb '{}' title '{}'", source,
                            state.colour, text::translated(state.word, text::language())));
    }
    return panel;
}

/// Returns the axis of time, which names the stays above the first panel and the hours below the
/// last.
std::string time_axis(const std::vector<Band>& stays, UtcTime first, UtcTime last) {
    std::vector<std::string> names;
    for (const Band& stay : stays)
        names.push_back(fmt::format("{} '{}'", gnuplot_string(stay.name), to_rfc3339(stay.start)));
    return fmt::format(
        "set xdata time\nset x2data time\nset timefmt '%Y-%m-%dT%H:%M:%SZ'\n"
        "set xrange ['{}':'{}']\nset link x2\nset xtics nomirror\nset format x ''\n"
        "set x2tics scale 0 rotate by 90 left font ',10' ({})\n",
        to_rfc3339(first), to_rfc3339(last), text::joined(names, ", \\\n    "));
}

/// Returns the label below the last panel and the format of its instants.
std::string time_label(UtcTime first, UtcTime last) {
    // Longest survey whose axis shows only hours; a longer one needs the date too.
    constexpr std::chrono::hours kLongestDay(36);
    const std::string first_date = to_rfc3339(first).substr(0, 10);
    const std::string last_date = to_rfc3339(last).substr(0, 10);
    return fmt::format("set format x {}\nset xlabel 'UTC, {}{}' offset 0,0.8\n",
                       last - first > kLongestDay ? "\"%H:%M\\n%m-%d\"" : "'%H:%M'", first_date,
                       first_date == last_date ? "" : " to " + last_date);
}

std::string caption_of(const model::SurveyCorrection& result, bool has_records, bool has_course,
                       bool has_verdicts) {
    using text::tr;
    const std::string errors =
        result.as<model::WholeDayPart>() != nullptr
            ? tr("The day. Above: reference minus the value of the reading if its station is left "
                 "out (cross-validated); bars: standard uncertainty u of this value.")
        : result.as<model::NetworkPart>() != nullptr
            ? tr("The day. Above: residuals, reference minus corrected value (in sample); bars: "
                 "standard uncertainty u of a single reading, a priori.")
            : tr("The day. Above: residuals, reference minus corrected value (in sample); bars: "
                 "standard uncertainty u as of a new station, from the scatter in sample.");
    return errors +
           (has_records ? tr(" Middle: samples of 2 s minus the mean of the reading; the scale "
                             "cuts off knocks.")
                        : "") +
           (has_course ? tr(" Below: temperature of the sensor and of the readings.")
                       : tr(" Below: temperature of the readings.")) +
           (has_verdicts ? tr(" Band: verdict that the recorder showed at the time, from its event "
                              "log.")
                         : "") +
           tr(" Shaded: stays (grey), averaged intervals (blue), stays without a value (red).");
}

}  // namespace

Figure day_figure(const model::SurveyCorrection& result, const std::vector<ReadingRecord>& records,
                  const std::vector<reading::MinuteTemperature>& course,
                  const std::vector<reading::VerdictSpan>& verdicts) {
    std::vector<Band> stays = stays_of(result, records);
    const std::vector<Band> lost = lost_stays_of(result);
    std::string script;
    for (const Band& stay : stays) script += shading(stay.start, stay.end, "'#eeeeee'");
    for (const Band& stay : lost) script += shading(stay.start, stay.end, "'#f7dccb'");
    for (const model::CorrectedRow& row : result.rows)
        if (row.row.start && row.row.end)
            script += shading(*row.row.start, *row.row.end, "'#cfe6f4'");
    stays.insert(stays.end(), lost.begin(), lost.end());
    UtcTime first = stays.front().start, last = first;
    std::size_t longest = 0;
    for (const Band& stay : stays) {
        first = std::min(first, stay.start);
        last = std::max(last, stay.end);
        longest = std::max(longest, stay.name.size());
    }
    if (!course.empty()) {
        first = std::min(first, course.front().middle);
        last = std::max(last, course.back().middle);
    }
    const auto margin = (last - first) / 50 + std::chrono::minutes(1);
    script = time_axis(stays, first - margin, last + margin) + script;

    FigureData data("day");
    std::vector<Panel> panels{error_panel(result, data), sample_panel(result, records),
                              temperature_panel(result, course, data),
                              verdict_panel(verdicts, data)};
    std::erase_if(panels, [](const Panel& panel) { return panel.clauses.empty(); });
    constexpr int kKey_px = 24, kBelow_px = 54, kBetween_px = 14;
    constexpr int kLetter_px = 6;  // width of a letter of 10 px
    const int above_px = kKey_px + 10 + kLetter_px * static_cast<int>(longest);
    int height_px = above_px + kBelow_px - kBetween_px;
    for (const Panel& panel : panels) height_px += panel.height_px + kBetween_px;
    script = fmt::format(
        "set multiplot\nset lmargin at screen 0.1\nset rmargin at screen 0.985\n{}"
        "set key at screen 0.1,0.995 left top horizontal maxrows 1\n",
        script);
    const auto share = [height_px](int px) {
        return text::fixed(1.0 - static_cast<double>(px) / height_px, 4);
    };
    int top_px = above_px;
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const Panel& panel = panels[i];
        if (i == 1) script += "unset link x2\nunset x2tics\nunset key\n";
        if (i + 1 == panels.size()) script += time_label(first, last);
        script +=
            fmt::format("set tmargin at screen {}\nset bmargin at screen {}\nset ylabel '{}'\n{}{}",
                        share(top_px), share(top_px + panel.height_px), panel.y_label,
                        panel.commands, plot_command(panel.clauses));
        top_px += panel.height_px + kBetween_px;
    }
    return data.figure(caption_of(result, !records.empty(), !course.empty(), !verdicts.empty()),
                       960, height_px, script + "unset multiplot\n");
}

}  // namespace a351::corrector::figure
