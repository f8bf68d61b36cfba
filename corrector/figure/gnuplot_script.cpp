#include "corrector/figure/gnuplot_script.hpp"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <string_view>

#include "corrector/figure/escaping.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::figure {
namespace {

// In the order of the enumerations.
// clang-format off
constexpr std::array kColours{
    "#0072B2", "#D55E00", "#009E73", "#E69F00", "#56B4E9", "#CC79A7", "#000000", "#888888",
    "#999999", "#aaaaaa", "#bbbbbb", "#e4e4e4", "#eeeeee", "#f7dccb", "#cfe6f4"};
constexpr std::array kLooks{
    "lines", "lines lw 0.7", "lines lw 1.2", "lines lw 1.5", "lines lw 2", "lines lw 2.5", "lines lw 9",
    "filledcurves", "boxes fs solid", "yerrorbars pt 0 lw 0.8", "points pt 7 ps 0.2",
    "points pt 7 ps 0.6", "points pt 7 ps 0.5",
    "points pt 2 ps 0.7 lw 1.5", "points pt 13 ps 0.8", "points pt 12 ps 0.6",
    "points pt 7 ps 0.9", "points pt 9 ps 1.1", "linespoints pt 7 ps 0.5",
    "yerrorbars pt 7 ps 0.6", "yerrorbars pt 6 ps 0.8 lw 1.2"};
// clang-format on
static_assert(kColours.size() == static_cast<std::size_t>(Colour::by_value));
static_assert(kLooks.size() == static_cast<std::size_t>(Look::circles_with_bars) + 1);
constexpr std::array kLetters{"", " font ',11'", " font ',10'"};
constexpr std::array kKeys{"tmargin left vertical maxrows 3 reverse Left samplen 2",
                           "tmargin center horizontal samplen 1.5 font ',11'",
                           "inside bottom right",
                           "inside left top horizontal maxrows 1 samplen 1.5",
                           "at screen 0.1,0.995 left top horizontal maxrows 1"};

template <class Table, class Entry>
auto entry_of(const Table& table, Entry entry) {
    return table.at(static_cast<std::size_t>(entry));
}

std::string number(double value) { return std::isnan(value) ? "*" : fmt::format("{:.10g}", value); }

/// Returns a text of several lines as an expression of gnuplot.
std::string expression(std::string_view text) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return gnuplot_string(text);
    return gnuplot_string(text.substr(0, end)) + ".\"\\n\"." + expression(text.substr(end + 1));
}

std::string value_on(const Axis& axis, double value) {
    if (axis.scale != Scale::time || std::isnan(value)) return number(value);
    return '\'' + to_rfc3339(UtcTime{} + from_seconds(value)) + '\'';
}

std::string place_in(const Panel& panel, const Place& place) {
    return fmt::format("{} {},{} {}", place.is_x_value ? "first" : "graph",
                       place.is_x_value ? value_on(panel.x, place.x) : number(place.x),
                       place.is_y_value ? "first" : "graph", number(place.y));
}

std::string ticks_of(const Axis& axis) {
    std::vector<std::string> names;
    for (const auto& [value, text] : axis.names)
        names.push_back(expression(text) + ' ' + number(value));
    if (!names.empty()) return '(' + text::joined(names) + ')';
    if (axis.step == 0.0) return "autofreq";
    if (axis.last_tick == 0.0) return number(axis.step);
    return fmt::format("{},{},{}", number(-axis.last_tick), number(axis.step),
                       number(axis.last_tick));
}

/// Adds the commands of an axis: the same number for every axis.
void add_axis(std::vector<std::string>& commands, const std::string& name, const Axis& axis,
              bool is_mirrored) {
    const bool is_time = axis.scale == Scale::time;
    commands.push_back(fmt::format("set {}label {}{}", name, expression(axis.label),
                                   is_time ? " offset 0,0.8" : ""));
    commands.push_back(fmt::format("set {}data{}", name, is_time ? " time" : ""));
    commands.push_back(fmt::format("set {}range [{}:{}]", name, value_on(axis, axis.range[0]),
                                   value_on(axis, axis.range[1])));
    commands.push_back(
        fmt::format("{} logscale {}", axis.scale == Scale::logarithmic ? "set" : "unset", name));
    const char* const turn = axis.slope == 0  ? "norotate"
                             : axis.slope > 0 ? "rotate by 45 right"
                                              : "rotate by -30 left";
    commands.push_back(axis.is_shown
                           ? fmt::format("set {}tics {} {} {}", name,
                                         is_mirrored ? "mirror" : "nomirror", turn, ticks_of(axis))
                           : fmt::format("unset {}tics", name));
    commands.push_back(fmt::format("set format {} {}", name, expression(axis.format)));
}

/// Returns the settings of a panel: the same number for every panel.
std::vector<std::string> settings_of(const Panel& panel) {
    std::vector<std::string> commands;
    const bool is_time = panel.x.scale == Scale::time;
    add_axis(commands, "x", panel.x, !is_time);
    add_axis(commands, "y", panel.y, !panel.right.is_shown);
    add_axis(commands, "y2", panel.right, false);
    add_axis(commands, "cb", panel.colours, true);
    commands.push_back("set title " + expression(panel.title));
    commands.push_back(fmt::format("set key {}", entry_of(kKeys, panel.key)));
    commands.push_back(fmt::format("set grid {}xtics", panel.x.names.empty() ? "" : "no"));
    const auto margin = [&panel](const Axis& axis, double share) {
        return panel.has_margin && std::isnan(axis.range[0]) ? share : 0.0;
    };
    commands.push_back(fmt::format("set offsets graph {0}, graph {0}, graph {1}, graph {2}",
                                   margin(panel.x, 0.03), panel.has_margin ? 0.05 : 0.0,
                                   margin(panel.y, 0.05)));
    // The last of the turned texts reaches to the right.
    commands.emplace_back(panel.x.slope < 0 ? "set rmargin 5" : "set rmargin");
    std::string spans = "unset object", lines = "unset arrow", texts = "unset label";
    for (const Span& span : panel.spans)
        spans += fmt::format(
            "\nset object rectangle from {},graph 0 to {},graph 1 fc rgb '{}' fs solid noborder "
            "behind",
            value_on(panel.x, span.from), value_on(panel.x, span.to),
            entry_of(kColours, span.colour));
    for (const Line& line : panel.lines)
        lines += fmt::format("\nset arrow from {} to {} {}", place_in(panel, line.from),
                             place_in(panel, line.to),
                             line.is_scale_bar ? "heads size graph 0.008,90 lw 1.5 front"
                                               : "nohead dt 2 lw 1 lc rgb '#D55E00'");
    for (const Text& text : panel.texts)
        texts += fmt::format(
            "\nset label {} at {} {}{}{}{} front", expression(text.text),
            place_in(panel, text.place), text.side, text.is_upright ? " rotate by 90" : "",
            text.place.is_y_value ? " offset 0,0.7" : "", entry_of(kLetters, text.letters));
    commands.insert(commands.end(), {spans, lines, texts});
    return commands;
}

std::string clause_of(const Series& series) {
    std::vector<std::string> columns;
    for (const auto& [number_of, plus, times] : series.columns)
        columns.push_back(plus == 0.0 && times == 1.0
                              ? fmt::format("{}", number_of)
                              : fmt::format("(${}{}{:+.14g})", number_of,
                                            times == 1.0 ? "" : "*" + number(times), plus));
    const bool has_data = series.source != kZero;
    return fmt::format("{}{}{} with {} {} {}", series.source,
                       has_data ? " using " + text::joined(columns, ":") : "",
                       series.is_right ? " axes x1y2" : "", entry_of(kLooks, series.look),
                       series.colour == Colour::by_value
                           ? "palette"
                           : fmt::format("lc rgb '{}'", entry_of(kColours, series.colour)),
                       series.label.empty() ? "notitle" : "title " + gnuplot_string(series.label));
}

std::string plot_of(const Panel& panel) {
    std::vector<std::string> clauses;
    for (const Series& series : panel.series)
        if (!series.source.empty()) clauses.push_back(clause_of(series));
    return fmt::format("plot {}\n", text::joined(clauses, ", \\\n     "));
}

/// Returns the commands that choose format, size and common style.
std::string head_of(const Figure& figure, int height_px) {
    constexpr double kPixelsPerInch = 96.0;
    // PNG has three times the size.  The scales make letters and marks of all formats look alike.
    return fmt::format(
        "# gnuplot {0}.gp writes {0}.svg; gnuplot -e \"format='pdf'\" {0}.gp a PDF (or 'png')\n"
        "reset\n"
        "if (!exists('format')) format = 'svg'\n"
        "if (format eq 'svg') set terminal svg noenhanced size {1},{2} font 'sans-serif,13'\n"
        "if (format eq 'pdf') set terminal pdfcairo noenhanced size {3}in,{4}in font "
        "'sans-serif,13' fontscale 0.56 pointscale 1.05\n"
        "if (format eq 'png') set terminal pngcairo noenhanced size {5},{6} font "
        "'sans-serif,13' fontscale 2.25 linewidth 3 pointscale 4.2\n"
        "set encoding utf8\n"
        "set output '{0}.'.format\n"
        "set border 15 lw 0.8\n"
        "set tics in scale 0.6\n"
        "set key {7}\n"
        "set grid lc rgb '#dddddd' lt 1 lw 0.6\n"
        "set boxwidth 0.7\n"
        "set timefmt '%Y-%m-%dT%H:%M:%SZ'\n"
        "set palette defined (0 '#440154', 1 '#3b528b', 2 '#21918c', 3 '#5ec962', 4 '#fde725')\n",
        figure.name, figure.width_px, height_px, text::fixed(figure.width_px / kPixelsPerInch, 3),
        text::fixed(height_px / kPixelsPerInch, 3), 3 * figure.width_px, 3 * height_px,
        kKeys.front());
}

/// Returns the margins of a panel in a frame, and removes what only the outer panels show.
/// @param top  distance of its row from the upper border.
std::string place(Panel& panel, const Figure& figure, std::size_t index, double top,
                  double height) {
    const Frame& frame = *figure.frame;
    const std::size_t column = index % frame.columns;
    const auto columns = static_cast<double>(frame.columns);
    const double width =
        (figure.width_px - frame.left - frame.right - (columns - 1.0) * frame.between_x) / columns;
    const double left = frame.left + static_cast<double>(column) * (width + frame.between_x);
    if (index + frame.columns < figure.panels.size()) panel.x.format = panel.x.label = "";
    if (column > 0) panel.y.format = "";
    if (frame.columns > 1) {
        panel.x.label = panel.y.label = "";
        // The labels of two panels, one above the other, must not touch.
        panel.y.last_tick = panel.y.step * std::floor(0.85 * panel.y.range[1] / panel.y.step);
    }
    return fmt::format(
        "set lmargin at screen {:.5f}; set rmargin at screen {:.5f}; set tmargin at screen {:.5f}; "
        "set bmargin at screen {:.5f}\n",
        left / figure.width_px, (left + width) / figure.width_px, 1.0 - top / height,
        1.0 - (top + panel.height_px) / height);
}

/// Returns the labels of the axes that all panels share.
std::string common_labels(const Panel& panel, int height_px) {
    constexpr double kMinutes_px = 14.0;
    return fmt::format(
        "set label {} at screen 0.53,{:.4f} center\nset label {} at screen 0.014,0.53 center "
        "rotate "
        "by 90\n",
        expression(panel.x.label), kMinutes_px / height_px, expression(panel.y.label));
}

}  // namespace

std::string script_of(const Figure& figure) {
    const std::size_t count = figure.panels.size();
    const Frame frame = figure.frame.value_or(Frame{});
    std::vector<double> tops{frame.above};  // of the rows, then the lower border
    for (std::size_t k = 0; k < count; k += frame.columns)
        tops.push_back(tops.back() + figure.panels[k].height_px + frame.between_y);
    const int height_px = figure.frame
                              ? static_cast<int>(tops.back() - frame.between_y + frame.below)
                              : figure.height_px;
    std::string script = head_of(figure, height_px);
    if (count > 1)
        script += figure.frame ? "set multiplot\n"
                               : fmt::format("set multiplot layout {},1\nset lmargin 12\n", count);
    std::vector<std::string> before = settings_of({});
    for (std::size_t k = 0; k < count; ++k) {
        Panel panel = figure.panels[k];
        const std::string margins =
            figure.frame ? place(panel, figure, k, tops.at(k / frame.columns), height_px) : "";
        std::vector<std::string> settings = settings_of(panel);
        for (std::size_t i = 0; i < settings.size(); ++i)
            if (settings[i] != before[i]) script += settings[i] + '\n';
        if (k == 0 && frame.columns > 1) script += common_labels(figure.panels[k], height_px);
        script += margins + plot_of(panel);
        before = std::move(settings);
    }
    return script + (count > 1 ? "unset multiplot\n" : "") + "unset output\n";
}

std::vector<text::NamedText> figure_files(const std::vector<Figure>& figures) {
    std::vector<text::NamedText> files;
    for (const Figure& figure : figures) {
        files.emplace_back(figure.name + ".gp", script_of(figure));
        if (!figure.data.empty()) files.emplace_back(figure.name + ".dat", figure.data);
    }
    return files;
}

}  // namespace a351::corrector::figure
