#include "corrector/figure/gnuplot_script.hpp"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "corrector/figure/escaping.hpp"
#include "corrector/figure/layout.hpp"
#include "corrector/figure/logarithmic_axis.hpp"
#include "corrector/figure/print_style.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector::figure {
namespace {

// In the order of the enumerations.
// clang-format off
constexpr std::array kColours{
    "#0072B2", "#D55E00", "#009E73", "#E69F00", "#56B4E9", "#CC79A7", "#000000", "#888888",
    "#999999", "#aaaaaa", "#bbbbbb", "#e4e4e4", "#eeeeee", "#f7dccb", "#cfe6f4"};
/// A look in gnuplot's words, before and after the width of its lines.
struct Style {
    const char* before;
    double line_pt = 0.0;  ///< 0: no lines.
    const char* after = "";
};
constexpr std::array<Style, 25> kLooks{{
    {"lines", kLine_pt}, {"lines", kThinLine_pt}, {"lines", kStrongLine_pt},
    {"lines", kStrongLine_pt, " dt (8,3)"}, {"lines", kStrongLine_pt, " dt (1,2)"},
    {"lines", 3.0}, {"filledcurves"}, {"boxes fs solid border lc black", kThinLine_pt},
    {"boxxyerror fs solid noborder"},
    {"yerrorbars pt 0", kThinLine_pt}, {"points pt 7 ps 0.12"}, {"points pt 7 ps 0.45"},
    {"points pt 7 ps 0.35"}, {"points pt 2 ps 0.5", kLine_pt}, {"points pt 13 ps 0.6"},
    {"points pt 12 ps 0.45", kThinLine_pt}, {"points pt 7 ps 0.7"}, {"points pt 9 ps 0.8"},
    {"linespoints pt 7 ps 0.4", kLine_pt}, {"linespoints pt 8 ps 0.5", kLine_pt},
    {"linespoints pt 4 ps 0.4", kLine_pt}, {"yerrorbars pt 7 ps 0.45", kThinLine_pt},
    {"yerrorbars pt 6 ps 0.6", kThinLine_pt}, {"yerrorbars pt 9 ps 0.6", kThinLine_pt},
    {"yerrorbars pt 12 ps 0.6", kThinLine_pt}}};
// clang-format on
static_assert(kColours.size() == static_cast<std::size_t>(Colour::by_value));
static_assert(kLooks.size() == static_cast<std::size_t>(Look::diamonds_with_bars) + 1);

/// Points of a line of width 1 in a script, whatever the format.
constexpr double kUnitLine_pt = 0.5;
constexpr double kPixelsPerInch = 96.0;  // of SVG and CSS

// In the order of the enumeration; widths are in units of kUnitLine_pt.
constexpr std::array kStrokes{"nohead dt (6,4) lw 1 lc rgb '#D55E00'",
                              "heads size graph 0.008,90 lw 2 front",
                              "nohead lw 1 lc rgb '#888888'"};

template <class Table, class Entry>
auto entry_of(const Table& table, Entry entry) {
    return table.at(static_cast<std::size_t>(entry));
}

std::string number(double value) { return std::isnan(value) ? "*" : fmt::format("{:.10g}", value); }

/// Returns " lw W" for a width in points.
std::string line_width(double points) {
    return points > 0.0 ? " lw " + number(points / kUnitLine_pt) : "";
}

std::string look_of(Look look) {
    const Style& style = entry_of(kLooks, look);
    return style.before + line_width(style.line_pt) + style.after;
}

/// Returns points in px of a screen, the unit of SVG.
double pixels(double points) { return points * kPixelsPerInch / kPointsPerInch; }

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
    return fmt::format("{} {},graph {}", place.is_x_value ? "first" : "graph",
                       place.is_x_value ? value_on(panel.x, place.x) : number(place.x),
                       number(place.y));
}

std::string ticks_of(const Axis& axis) {
    std::vector<std::string> names;
    for (const auto& [value, text] : axis.names)
        names.push_back(expression(text) + ' ' + number(value));
    if (!names.empty()) return '(' + text::joined(names) + ')';
    if (axis.scale == Scale::logarithmic)
        if (std::string ticks = logarithmic_ticks(axis.range); !ticks.empty()) return ticks;
    if (axis.step == 0.0) return "autofreq";
    return number(axis.step);
}

/// Adds the commands of an axis: the same number for every axis.
void add_axis(std::vector<std::string>& commands, const std::string& name, const Axis& axis,
              bool is_mirrored) {
    const bool is_time = axis.scale == Scale::time;
    commands.push_back(fmt::format("set {}data{}", name, is_time ? " time" : ""));
    commands.push_back(fmt::format("set {}range [{}:{}]", name, value_on(axis, axis.range[0]),
                                   value_on(axis, axis.range[1])));
    commands.push_back(
        fmt::format("{} logscale {}", axis.scale == Scale::logarithmic ? "set" : "unset", name));
    commands.push_back(axis.is_shown
                           ? fmt::format("set {}tics {} norotate {}", name,
                                         is_mirrored ? "mirror" : "nomirror", ticks_of(axis))
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
    commands.push_back(fmt::format("set grid {}xtics", panel.x.names.empty() ? "" : "no"));
    const auto margin = [&panel](const Axis& axis, double share) {
        return panel.has_margin && std::isnan(axis.range[0]) ? share : 0.0;
    };
    commands.push_back(fmt::format("set offsets graph {0}, graph {0}, graph {1}, graph {2}",
                                   margin(panel.x, 0.03), panel.has_margin ? 0.05 : 0.0,
                                   margin(panel.y, 0.05)));
    std::string spans = "unset object", lines = "unset arrow", texts = "unset label";
    for (const Span& span : panel.spans)
        spans += fmt::format(
            "\nset object rectangle from {},graph 0 to {},graph 1 fc rgb '{}' fs solid noborder "
            "behind",
            value_on(panel.x, span.from), value_on(panel.x, span.to),
            entry_of(kColours, span.colour));
    for (const Line& line : panel.lines)
        lines += fmt::format("\nset arrow from {} to {} {}", place_in(panel, line.from),
                             place_in(panel, line.to), entry_of(kStrokes, line.stroke));
    for (const Text& text : panel.texts)
        texts +=
            fmt::format("\nset label {} at {} {} font ',{}' front", expression(text.text),
                        place_in(panel, text.place), text.side, number(pixels(kSmallLetters_pt)));
    commands.insert(commands.end(), {spans, lines, texts});
    return commands;
}

std::string clause_of(const Series& series) {
    const bool has_data = series.source != kZero;
    return fmt::format("{}{}{} with {} {} {}", series.source,
                       has_data ? fmt::format(" using {}", fmt::join(series.columns, ":")) : "",
                       series.is_right ? " axes x1y2" : "", look_of(series.look),
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
std::string head_of(const Figure& figure, double height_mm) {
    const double letters = pixels(kLetters_pt), line = pixels(kUnitLine_pt);
    const double png = kPngDotsPerInch / kPixelsPerInch;  // pixels of PNG per px
    const auto inches = [](double mm) { return mm / kMmPerInch; };
    // pointintervalbox: error bars reach their marks (gnuplot ignores 0, and 0.001 is the
    // scale 0.00 in SVG, which viewers refuse).
    // cairo takes a font of size n as 4/3 n px, or n pt; its unit line is 0.5 pt in a PDF and 1
    // pixel in a PNG.  The scales of the points make marks of all formats look alike.
    return fmt::format(
        "# gnuplot {0}.gp writes {0}.svg; gnuplot -e \"format='pdf'\" {0}.gp a PDF (or 'png')\n"
        "# Width {1} mm, height {2} mm; letters {3} pt; a line of width 1 has {4} pt.\n"
        "reset\n"
        "if (!exists('format')) format = 'svg'\n"
        "if (format eq 'svg') set terminal svg noenhanced size {5:.0f},{6:.0f} font "
        "'sans-serif,{7}' linewidth {8:.4g}\n"
        "if (format eq 'pdf') set terminal pdfcairo noenhanced size {9:.3f}in,{10:.3f}in font "
        "'sans-serif,{7}' fontscale {11:.5g} pointscale 1.05\n"
        "if (format eq 'png') set terminal pngcairo noenhanced size {12:.0f},{13:.0f} font "
        "'sans-serif,{7}' fontscale {14:.5g} linewidth {15:.4g} pointscale {16:.4g}\n"
        "set encoding utf8\n"
        "set minussign\n"
        "set output '{0}.'.format\n"
        "set border 15 lw 1\n"
        "set tics in scale 0.5\n"
        "set grid lc rgb '#dddddd' lt 1 lw 1\n"
        "set boxwidth 0.7\n"
        "set errorbars small\n"
        "set pointintervalbox 0.01\n"
        "set timefmt '%Y-%m-%dT%H:%M:%SZ'\n"
        "set palette defined (0 '#440154', 1 '#3b528b', 2 '#21918c', 3 '#5ec962', 4 '#fde725')\n",
        figure.name, number(figure.width_mm), number(std::round(height_mm)), number(kLetters_pt),
        number(kUnitLine_pt), inches(figure.width_mm) * kPixelsPerInch,
        inches(height_mm) * kPixelsPerInch, number(letters), line, inches(figure.width_mm),
        inches(height_mm), 0.75 * 0.75, inches(figure.width_mm) * kPngDotsPerInch,
        inches(height_mm) * kPngDotsPerInch, 0.75 * png, line * png, 1.4 * png);
}

double rightmost(const Layout& layout) {
    double right = 0.0;
    for (const PanelPlace& place : layout.panels) right = std::max(right, place.right);
    return right;
}

/// Returns the border of a panel, its key and the texts around it.
std::string place_texts(const Figure& figure, const Layout& layout, std::size_t index) {
    const PanelPlace& place = layout.panels[index];
    const Panel& panel = figure.panels[index];
    const auto across = [&](double mm) { return fmt::format("{:.5f}", mm / figure.width_mm); };
    const auto up = [&](double mm) { return fmt::format("{:.5f}", 1.0 - mm / layout.height_mm); };
    std::string commands = fmt::format(
        "set lmargin at screen {}; set rmargin at screen {}; set tmargin at screen {}; "
        "set bmargin at screen {}\n",
        across(place.left), across(place.right), up(place.top), up(place.bottom));
    // SVG has higher lines than the other formats.
    commands += place.key_rows == 0
                    ? "unset key\n"
                    : fmt::format(
                          "set key at screen {},{} left top vertical maxrows {} reverse "
                          "Left samplen 2 spacing format eq 'svg' ? 0.85 : 1.1\n",
                          across(place.left), up(place.key), place.key_rows);
    const auto add = [&](const std::string& text, double x, double y, const std::string& side) {
        if (!text.empty())
            commands += fmt::format("set label {} at screen {},{} {}\n", expression(text),
                                    across(x), up(y), side);
    };
    const std::string left = left_heading(figure, index);
    constexpr double kBorder_mm = 1.0;
    add(left, text_width_mm(left) < place.right - place.left ? place.left : kBorder_mm,
        place.heading, "left");
    add(right_heading(panel), place.right, place.note, "right");
    if (index == 0 && figure.columns > 1 && figure.has_common_y)
        add(label_of(panel.y), kBorder_mm, 0.5 * kTextLine_mm, "left");
    if (index + 1 == figure.panels.size())
        add(label_of(panel.x), 0.5 * (layout.panels.front().left + rightmost(layout)),
            layout.height_mm - 0.5 * kTextLine_mm, "center");
    for (std::size_t k = 0; k < panel.names.size(); ++k)
        if (!std::isnan(place.names[k]))
            commands += fmt::format("set label {} at first {}, screen {} center font ',{}'\n",
                                    expression(panel.names[k].second),
                                    value_on(panel.x, panel.names[k].first), up(place.names[k]),
                                    number(pixels(kSmallLetters_pt)));
    if (!panel.colours.label.empty())
        commands +=
            fmt::format("set colorbox user origin screen {},{} size screen {},{} front\n",
                        across(place.right + 2.0), up(place.bottom), across(3.0),
                        fmt::format("{:.5f}", (place.bottom - place.top) / layout.height_mm));
    return commands;
}

}  // namespace

std::string script_of(const Figure& figure) {
    const std::size_t count = figure.panels.size();
    const Layout layout = layout_of(figure);
    std::string script = head_of(figure, layout.height_mm);
    if (count > 1) script += "set multiplot\n";
    std::vector<std::string> before = settings_of({});
    for (std::size_t k = 0; k < count; ++k) {
        Panel panel = figure.panels[k];
        set_decades(panel, figure);
        if (!layout.panels[k].has_x) panel.x.format = "";
        if (!layout.panels[k].has_y) panel.y.format = "";
        std::vector<std::string> settings = settings_of(panel);
        for (std::size_t i = 0; i < settings.size(); ++i)
            if (settings[i] != before[i]) script += settings[i] + '\n';
        if (k > 0 && settings.back() == before.back()) script += settings.back() + '\n';
        script += place_texts(figure, layout, k) + plot_of(panel);
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
