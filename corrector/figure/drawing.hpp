#pragma once
/// @file
/// Figures -> pictures, by gnuplot.

#include <string>
#include <vector>

#include "corrector/figure/figure.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector {

/// Formats of pictures besides SVG.
[[nodiscard]] const std::vector<std::string>& picture_formats();

struct Drawing {
    std::vector<text::NamedText> pictures;  ///< NAME.FORMAT, in the order of figures, then formats.
    std::vector<std::string> troubles;      ///< Why pictures are missing; one line each.
};

/// Draws all figures in a folder of its own for temporary files.  One process draws all of a
/// format; when it fails, each figure is tried alone, so that one bad figure costs no other.
/// The same figures give the same bytes with the same gnuplot.
[[nodiscard]] Drawing draw(const std::vector<Figure>& figures,
                           const std::vector<std::string>& formats);

}  // namespace a351::corrector
