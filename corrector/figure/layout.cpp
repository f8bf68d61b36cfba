#include "corrector/figure/layout.hpp"

#include <algorithm>
#include <cmath>

#include "corrector/figure/print_style.hpp"

namespace a351::corrector::figure {
namespace {

constexpr double kGap_mm = 0.8;  // between texts and the panel below them
constexpr double kBetweenPanels_mm = 3.0;
constexpr double kBetweenTexts_mm = 1.5;
constexpr double kKeySample_mm = 9.0;  // sample of a series in the key, with blanks

double right_margin_mm(const Panel& panel) {
    if (!panel.colours.label.empty()) return kColourScale_mm;
    return panel.right.is_shown ? kRightAxis_mm : kRight_mm;
}

/// Returns the lines of a text.
double lines_of(const std::string& text) {
    return text.empty() ? 0.0 : 1.0 + static_cast<double>(std::ranges::count(text, '\n'));
}

/// Returns the width of a column of the key with this text.  gnuplot takes the real widths for PDF
/// and PNG; for SVG it takes 0.7 of the letters' size for each letter and for seven more.
double key_column_mm(const std::string& label) {
    const auto letters = std::ranges::count_if(
        label, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; });
    constexpr double kSvgLetter_mm = 0.7 * kLetters_pt * kMmPerInch / kPointsPerInch;
    return std::max(text_width_mm(label) + kKeySample_mm,
                    kSvgLetter_mm * static_cast<double>(letters + 7));
}

std::size_t key_rows_of(const Panel& panel, double width_mm) {
    std::size_t count = 0;
    double widest_mm = 0.0;
    for (const Series& series : panel.series) {
        if (series.label.empty() || series.source.empty()) continue;
        ++count;
        widest_mm = std::max(widest_mm, key_column_mm(series.label));
    }
    if (count == 0) return 0;
    const double room = std::floor(width_mm / widest_mm);
    const auto columns = static_cast<std::size_t>(std::max(1.0, room));
    return (count + columns - 1) / columns;
}

/// Returns the row of each name, 0 is the lowest: the first in which it does not touch the name
/// before.  Names without room in the highest row get the number of rows.
std::vector<std::size_t> rows_of_names(const Panel& panel, double left_mm, double width_mm) {
    constexpr std::size_t kMostRows = 6;
    std::vector<double> ends(kMostRows, 0.0);
    std::vector<std::size_t> rows;
    for (const auto& [value, name] : panel.names) {
        const double middle_mm =
            left_mm + width_mm * (value - panel.x.range[0]) / (panel.x.range[1] - panel.x.range[0]);
        const double half_mm = text_width_mm(name, kSmallLetters_pt) / 2.0;
        std::size_t row = 0;
        while (row < kMostRows && ends[row] > middle_mm - half_mm) ++row;
        if (row < kMostRows) ends[row] = middle_mm + half_mm + kBetweenTexts_mm;
        rows.push_back(row);
    }
    return rows;
}

/// Sets the places of the texts above a panel that begin at `y`, and returns the place of the panel.
double place_texts_above(PanelPlace& place, const Figure& figure, std::size_t index, double y) {
    const Panel& panel = figure.panels[index];
    const std::string left = left_heading(figure, index), right = right_heading(panel);
    place.heading = place.note = y + 0.5 * kTextLine_mm;
    if (!left.empty() || !right.empty()) y += kTextLine_mm;
    const double from = left.empty() ? 0.0 : text_width_mm(left) + kBetweenTexts_mm;
    if (!right.empty() && from + text_width_mm(right) > place.right - place.left) {
        place.note += kTextLine_mm;
        y += kTextLine_mm;
    }
    place.key = y;
    place.key_rows = key_rows_of(panel, place.right - place.left);
    y += kTextLine_mm * static_cast<double>(place.key_rows);
    const std::vector<std::size_t> rows =
        rows_of_names(panel, place.left, place.right - place.left);
    std::size_t most = 0;
    for (const std::size_t row : rows) most = std::max(most, std::min<std::size_t>(row + 1, 6));
    for (const std::size_t row : rows)
        place.names.push_back(
            row < most ? y + kTextLine_mm * (static_cast<double>(most - row) - 0.5) : std::nan(""));
    y += kTextLine_mm * static_cast<double>(most);
    return y + kGap_mm;
}

}  // namespace

double panel_width_mm(double width_mm, const Panel& panel) {
    return width_mm - kLeft_mm - right_margin_mm(panel);
}

std::string label_of(const Axis& axis) {
    std::string label = " " + axis.label;
    for (std::size_t at = 0; (at = label.find(" - ", at)) != std::string::npos;)
        label.replace(at, 3, " \u2212 ");
    return label.substr(1);
}

std::string left_heading(const Figure& figure, std::size_t panel) {
    const Panel& one = figure.panels[panel];
    if (figure.columns > 1) return one.heading;
    if (figure.panels.size() == 1 || panel > 25) return label_of(one.y);
    return std::string("(") + static_cast<char>('a' + panel) + ") " + label_of(one.y);
}

std::string right_heading(const Panel& panel) {
    return panel.right.is_shown           ? label_of(panel.right)
           : !panel.colours.label.empty() ? label_of(panel.colours)
                                          : panel.note;
}

Layout layout_of(const Figure& figure) {
    Layout layout;
    const std::size_t count = figure.panels.size();
    const auto columns = static_cast<double>(figure.columns);
    const bool has_common_y = figure.columns > 1 && figure.has_common_y;
    double y = has_common_y ? kTextLine_mm : 0.0;  // its label
    const double between_mm = has_common_y ? kBetweenPanels_mm : kLeft_mm;
    double lowest = y;
    for (std::size_t first = 0; first < count; first += figure.columns) {
        double top = y;
        const std::size_t end = std::min(count, first + figure.columns);
        for (std::size_t k = first; k < end; ++k) {
            PanelPlace& place = layout.panels.emplace_back();
            const auto column = static_cast<double>(k - first);
            const double right_mm = right_margin_mm(figure.panels[k]);
            const double width =
                (figure.width_mm - kLeft_mm - right_mm - (columns - 1.0) * between_mm) / columns;
            place.left = kLeft_mm + column * (width + between_mm);
            place.right = place.left + width;
            place.has_x = k + figure.columns >= count;
            place.has_y = k == first || !has_common_y;
            top = std::max(top, place_texts_above(place, figure, k, y));
        }
        for (std::size_t k = first; k < end; ++k) {
            PanelPlace& place = layout.panels[k];
            place.top = top;
            place.bottom = top + figure.panels[k].height_mm;
            lowest = std::max(lowest, place.bottom);
        }
        y = lowest + kGap_mm;
    }
    // Below the last row: numbers, or names, of the x axis and its label.
    double lines = 0.0;
    for (const Panel& panel : figure.panels) {
        double numbers = panel.x.is_shown ? lines_of(panel.x.format) : 0.0;
        for (const auto& [value, name] : panel.x.names) numbers = std::max(numbers, lines_of(name));
        lines = std::max(lines, numbers + lines_of(panel.x.label));
    }
    constexpr double kTicks_mm = 2.0;  // from the axis to its numbers
    layout.height_mm = lowest + kTicks_mm + kTextLine_mm * lines;
    return layout;
}

}  // namespace a351::corrector::figure
