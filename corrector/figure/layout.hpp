#pragma once
/// @file
/// Places of the panels of a figure and of the texts around them, in mm.
///
/// Panels are in rows of Figure::columns.  Those of a column share the x axis: only the lowest has
/// numbers and a label there.  In several columns they share the y axis too.  Above a panel are its
/// headings, then its key, then the names of its marks, each in as many lines as needed so that no
/// two texts touch.

#include <cstddef>
#include <string>
#include <vector>

#include "corrector/figure/figure.hpp"

namespace a351::corrector::figure {

/// Places in mm from the left and upper border of the figure.
struct PanelPlace {
    double left = 0.0, right = 0.0, top = 0.0, bottom = 0.0;  ///< Border of the panel.
    double heading = 0.0, note = 0.0;  ///< Middles of the lines of the headings.
    double key = 0.0;                  ///< Upper border of the key.
    std::size_t key_rows = 0;
    std::vector<double> names = {};   ///< Middles of the lines; NaN: no room, it is left out.
    bool has_x = true, has_y = true;  ///< There are numbers at the axis.
};

struct Layout {
    double height_mm = 0.0;
    std::vector<PanelPlace> panels = {};
};

[[nodiscard]] Layout layout_of(const Figure& figure);

/// Returns the width of a panel that has a row for itself, mm.
[[nodiscard]] double panel_width_mm(double width_mm, const Panel& panel);

/// Returns the label of an axis with a minus sign for a hyphen between blanks.
[[nodiscard]] std::string label_of(const Axis& axis);

/// Returns the heading at the left of a panel: its letter, if it is one of several in a column, and
/// the label of its y axis; in several columns its own heading.
[[nodiscard]] std::string left_heading(const Figure& figure, std::size_t panel);
/// Returns the heading at the right: the label of the right axis or of the colours, or the note.
[[nodiscard]] std::string right_heading(const Panel& panel);

}  // namespace a351::corrector::figure
