#include "corrector/figure/history_figure.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "protocol/text/catalogue.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {
namespace {

constexpr std::array<std::string_view, 4> kShown{"constant_mgal", "temperature_mgal_per_degc",
                                                 "slow_temperature_mgal_per_degc",
                                                 "placement_mgal"};
/// Colours and marks of the units in turn.
constexpr std::array<std::pair<Look, Colour>, 4> kUnitMarks{
    {{Look::discs_with_bars, Colour::blue},
     {Look::circles_with_bars, Colour::vermilion},
     {Look::triangles_with_bars, Colour::green},
     {Look::diamonds_with_bars, Colour::purple}}};

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
        lines += to_rfc3339(day.start) + ' ' +
                 data_line("55", {day.terms[k]->value, day.terms[k]->standard_error.value_or(0.0)});
    }
    return lines;
}

/// Returns the distance of the dates below a panel, s: whole days, and as many dates as have room.
int date_step_s(const std::vector<result::UnitDay>& days, const Print& print) {
    constexpr int kDay_s = 86'400;
    const double most_dates = print.is_narrow() ? 2.0 : 5.0;
    const auto [first, last] = std::ranges::minmax(days, {}, &result::UnitDay::start);
    const double span_days = seconds_between(first.start, last.start) / kDay_s;
    return kDay_s * std::max(1, static_cast<int>(std::ceil(span_days / most_dates)));
}

}  // namespace

Figure history_figure(const std::vector<result::UnitDay>& days, const Print& print) {
    std::vector<std::string> units;
    for (const result::UnitDay& day : days)
        if (units.empty() || units.back() != day.serial_number) units.push_back(day.serial_number);
    Figure figure{"history",
                  text::tr("Terms of the unit by day, with bars of one standard uncertainty."),
                  print.wide_mm()};
    for (const std::string_view name : kShown) {
        const std::size_t k = index_of(name);
        Panel& panel = figure.panels.emplace_back();
        panel.x = {.step = static_cast<double>(date_step_s(days, print)),
                   .format = "%m-%d\n%Y",
                   .scale = Scale::time};
        panel.y.label = text::translated(result::term_kinds()[k].heading);
        panel.has_margin = true;
        panel.height_mm = kStackedPanel_mm;
        for (std::size_t unit = 0; unit < units.size(); ++unit)
            figure.plot(fmt::format("time {} u", name), lines_of(days, units[unit], k),
                        {kUnitMarks.at(unit % kUnitMarks.size()).first,
                         kUnitMarks.at(unit % kUnitMarks.size()).second,
                         units.size() > 1 ? units[unit] : "",
                         {1, 2, 3}},
                        figure.panels.size() - 1);
        if (panel.series.empty()) figure.panels.pop_back();
    }
    return figure;
}

}  // namespace a351::corrector::figure
