#include "corrector/figure/history_figure.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "corrector/figure/escaping.hpp"
#include "protocol/text/catalogue.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {
namespace {

constexpr std::array<std::string_view, 4> kShown{"constant_mgal", "temperature_mgal_per_degc",
                                                 "slow_temperature_mgal_per_degc",
                                                 "placement_mgal"};
/// Colours of the units in turn, of Okabe and Ito.
const std::array<std::string, 4> kColours{kBlue, kVermilion, "'#009E73'", "'#CC79A7'"};
constexpr int kPanel_px = 190, kWidth_px = 900;

std::size_t index_of(std::string_view name) {
    const auto& kinds = result::term_kinds();
    return static_cast<std::size_t>(std::ranges::find(kinds, name, &result::TermKind::name) -
                                    kinds.begin());
}

/// Returns the days of a unit that have the term: time, value, uncertainty.
std::string lines_of(const std::vector<result::UnitDay>& days, const std::string& unit,
                     std::size_t k) {
    std::string lines;
    for (const result::UnitDay& day : days) {
        if (day.serial_number != unit || !day.terms[k]) continue;
        lines += to_rfc3339(day.start) + ' ' + datum(day.terms[k]->value, 5) +
                 datum(day.terms[k]->standard_error.value_or(0.0), 5) + '\n';
    }
    return lines;
}

/// Returns the distance of the dates below a panel, s: whole days, at most six dates.
int date_step_s(const std::vector<result::UnitDay>& days) {
    constexpr int kDay_s = 86'400;
    constexpr double kMostDates = 5.0;
    const auto [first, last] = std::ranges::minmax(days, {}, &result::UnitDay::start);
    const double span_days = seconds_between(first.start, last.start) / kDay_s;
    return kDay_s * std::max(1, static_cast<int>(std::ceil(span_days / kMostDates)));
}

}  // namespace

Figure history_figure(const std::vector<result::UnitDay>& days) {
    std::vector<std::string> units;
    for (const result::UnitDay& day : days)
        if (units.empty() || units.back() != day.serial_number) units.push_back(day.serial_number);
    FigureData data("history");
    std::string panels;
    int count = 0;
    for (const std::string_view name : kShown) {
        const std::size_t k = index_of(name);
        std::vector<std::string> clauses;
        for (std::size_t unit = 0; unit < units.size(); ++unit) {
            const std::string source =
                data.add(fmt::format("time {} u", name), lines_of(days, units[unit], k));
            if (source.empty()) continue;
            clauses.push_back(fmt::format(
                "{} using (timecolumn(1, '%Y-%m-%dT%H:%M:%SZ')):2:3 with yerrorbars pt 7 ps 0.6 lc "
                "rgb {} title {}",
                source, kColours.at(unit % kColours.size()), gnuplot_string(units[unit])));
        }
        if (clauses.empty()) continue;
        ++count;
        panels += fmt::format(
            "set ylabel {}\n{}",
            gnuplot_string(text::translated(result::term_kinds()[k].heading, text::language())),
            plot_command(clauses));
    }
    return data.figure(
        text::tr("Terms of the unit by day, with bars of one standard uncertainty."), kWidth_px,
        kPanel_px * std::max(count, 1),
        fmt::format("set xdata time\nset format x '%Y-%m-%d'\nset xtics {}\nset grid\nset "
                    "offsets graph 0.03, graph 0.03, graph 0.1, graph 0.1\nset lmargin 12\nset key "
                    "{}\nset multiplot layout {},1\n{}unset multiplot\n",
                    date_step_s(days), units.size() > 1 ? "outside right" : "off",
                    std::max(count, 1), panels));
}

}  // namespace a351::corrector::figure
