#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "corrector/figure/record_curve.hpp"
#include "protocol/core/units.hpp"
#include "protocol/signal/moments.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::figure {
namespace {

using long_record::RecordResult;
using text::fixed, text::tr;

/// Time per width of the figure with both modes, h/mm: 4 h in a column, 8 h on a page.  Reason: in
/// a longer one the curves cannot be distinguished.
constexpr double kOverlay_h_per_mm = 4.0 / kColumn_mm;

/// Returns the panel of a mode, or of the residue about its mean.
Panel mode_panel(const std::string& heading, std::span<const double> values, double offset,
                 double factor, const std::string& x_label) {
    double most = 0.0;
    for (const double value : values) most = std::max(most, factor * std::abs(value - offset));
    if (most == 0.0) most = 1.0;
    // The height of a panel is enough for three numbers only.
    const double tick = round_step(most);
    Panel panel{.x = {.label = x_label}, .y = {.range = {-most, most}, .format = "%g"}};
    for (const double at : {-tick, 0.0, tick})
        panel.y.names.emplace_back(at,
                                   fmt::format("{}{:g}", at < 0.0 ? "\u2212" : "", std::abs(at)));
    panel.heading = heading;
    panel.height_mm = 12.0;
    return panel;
}

}  // namespace

bool is_published_pair(const RecordResult& result) {
    // Period of the publication's sixth modes: statistics_table().
    constexpr double kLeast_s = 600.0, kGreatest_s = 900.0;
    const auto& mode = result.analysis.temperature_mode;
    return mode && mode->period_s >= kLeast_s && mode->period_s <= kGreatest_s &&
           result.options.shift_s == long_record::RecordAnalysisOptions{}.shift_s;
}

ModePair mode_pair(const RecordResult& result) {
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

Figure overlay_figure(const RecordResult& result, const ModePair& pair, const Print& print) {
    const double step_h = step_h_of(result);
    const std::size_t size = pair.turned.size();
    const std::size_t count =
        std::min(size, static_cast<std::size_t>(kOverlay_h_per_mm * print.wide_mm() / step_h));
    const std::size_t first = (size - count) / 2;
    Figure figure{
        "modes",
        tr("Modes of the cycle: acceleration, sign reversed and moved {} s earlier, and "
           "temperature{}.",
           fixed(result.options.shift_s, 0), count < size ? tr("; the middle of the record") : "") +
            as_published("5"),
        print.wide_mm()};
    figure.panels.push_back({.x = {hours_after(result.segment().start)},
                             .y = {tr("- Acceleration (mGal)")},
                             .right = {tr("Temperature (°C)")}});
    const auto lines = [&](const std::vector<double>& mode) {
        return curve_lines(
            {std::span(mode).subspan(first, count), step_h, static_cast<double>(first) * step_h});
    };
    figure.plot("hours; acceleration, sign reversed and moved (mGal)", lines(pair.turned),
                {.label = tr("acceleration, sign reversed and moved")});
    figure.plot("hours temperature_degc", lines(pair.temperature),
                {.look = Look::dashed_line,
                 .colour = Colour::vermilion,
                 .label = tr("temperature"),
                 .is_right = true});
    return figure;
}

Figure correlation_figure(const RecordResult& result, const Print& print) {
    const long_record::RecordAnalysis& analysis = result.analysis;
    const auto lines = [](const signal::CrossCorrelation& correlation) {
        std::string text;
        for (std::size_t i = 0; i < correlation.values.size(); ++i)
            text += data_line("15", {correlation.delays_s[i], correlation.values[i]});
        return text;
    };
    const signal::CrossCorrelation& modes = analysis.modes->correlation;
    const double chance = analysis.modes->chance, end_s = modes.delays_s.back();
    Figure figure{
        "correlation",
        tr("Cross-correlation of the two modes, and of the band, against the delay of the "
           "acceleration; negative peak of the modes {} at {} s. Two unrelated series that "
           "oscillate "
           "as the modes do are within the dotted lines at 95 % of the delays.",
           fixed(modes.negative.value, 2), fixed(modes.negative.delay_s, 0)) +
            as_published("7", is_published_pair(result)
                                  ? published_value(result, "mode_negative_delay_s") + " s"
                                  : ""),
        print.small_mm()};
    figure.panels.push_back({{.label = tr("Delay of the acceleration (s)"),
                              .range = {-end_s, end_s},
                              .step = round_step(end_s / 1.7)},
                             {tr("Correlation"), {-1.0, 1.0}},
                             {{Look::thin_line, Colour::grey, "", {1, 2}, kZero}}});
    figure.plot("modes: delay_s correlation", lines(modes),
                {Look::strong_line, Colour::blue, tr("modes")});
    figure.plot("band: delay_s correlation", lines(analysis.band.correlation),
                {Look::dashed_line, Colour::vermilion, tr("band")});
    std::string limits;
    for (const double limit : {-chance, chance})
        limits += data_line("15", {-end_s, limit}) + data_line("15", {end_s, limit}) + '\n';
    figure.plot("limits of 95 %: delay_s correlation", limits,
                {Look::dotted_line, Colour::black, tr("limits of 95 %")});
    return figure;
}

Figure decomposition_figure(const RecordResult& result, const Print& print) {
    struct Side {
        const char* title;
        const eemd::Result& modes;
        const std::optional<long_record::ChosenMode>& chosen;
        double factor;
        Colour colour;
    };
    const long_record::RecordAnalysis& analysis = result.analysis;
    const std::array<Side, 2> sides{{{"acceleration_mgal", analysis.acceleration,
                                      analysis.acceleration_mode, 1.0, Colour::blue},
                                     {"temperature_mdegc", analysis.temperature,
                                      analysis.temperature_mode, 1000.0, Colour::vermilion}}};
    Figure figure{
        "decomposition",
        tr("All modes with their mean periods, and the residues about their means: "
           "acceleration in mGal (left) and temperature in 0.001 °C (right). * modes that "
           "are compared."),
        print.wide_mm()};
    figure.columns = sides.size();
    figure.has_common_y = false;
    const std::string hours = hours_after(result.segment().start);
    const auto add = [&](const Side& side, const std::string& heading,
                         const std::vector<double>& values, double offset) {
        figure.panels.push_back(mode_panel(heading, values, offset, side.factor, hours));
        figure.plot(fmt::format("{}: hours {}", heading, side.title),
                    curve_lines({values, step_h_of(result), 0.0, offset, side.factor}),
                    {Look::thin_line, side.colour}, figure.panels.size() - 1);
    };
    for (std::size_t k = 0; k < analysis.acceleration.modes.size(); ++k) {
        if (std::ranges::all_of(
                sides, [k](const Side& side) { return side.modes.modes[k].extrema_count == 0; }))
            break;  // slower modes do not oscillate either
        for (const Side& side : sides) {
            const eemd::Component& mode = side.modes.modes[k];
            const double period_s = mode.mean_period_samples * result.record.step_s;
            add(side,
                mode.extrema_count == 0
                    ? tr("mode {}: none", k + 1)
                    : tr("mode {}: {} s{}", k + 1, fixed(period_s, 0),
                         side.chosen && side.chosen->number == k + 1 ? " *" : ""),
                mode.values, 0.0);
        }
    }
    for (const Side& side : sides)
        add(side, tr("residue"), side.modes.residue.values,
            signal::mean_of(side.modes.residue.values));
    return figure;
}

}  // namespace a351::corrector::figure
