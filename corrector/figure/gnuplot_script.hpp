#pragma once
/// @file
/// The gnuplot script of a figure: the only place that knows marks, colours and the language of
/// gnuplot.  Sizes are those of print_style.hpp, places those of layout.hpp.

#include <string>

#include "corrector/figure/figure.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector::figure {

/// Returns the content of NAME.gp.
///
/// The script resets the settings of earlier scripts, chooses the terminal by `format` (default
/// svg), and sets the output and the common style.  Each panel sets only what differs from the
/// panel before it.
///
/// Texts may have any bytes: they are quoted, so that they are drawn literally and execute nothing
/// (drawing_test.cpp).  The terminal is `noenhanced`: `_`, `^` and braces are shown as they are.
[[nodiscard]] std::string script_of(const Figure& figure);

/// Returns NAME.gp of each figure, and NAME.dat if it has data.
[[nodiscard]] std::vector<text::NamedText> figure_files(const std::vector<Figure>& figures);

}  // namespace a351::corrector::figure
