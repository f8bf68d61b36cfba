#pragma once
/// @file
/// From figures to pictures, by gnuplot.

#include <string>
#include <vector>

#include "corrector/figure/figure.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector {

/// Returns the formats of pictures other than SVG.
[[nodiscard]] const std::vector<std::string>& picture_formats();

/// The pictures that could be drawn.
struct Drawing {
    std::vector<text::NamedText>
        pictures;                       ///< NAME.FORMAT; of each format, in the order of figures.
    std::vector<std::string> troubles;  ///< Reasons for missing pictures; one line each.
};

/// Draws all figures, in a temporary folder.
///
/// One process draws all figures of a format.  If it fails, each figure is drawn alone, so that one
/// bad figure does not affect the others.  The same figures give the same bytes with the same
/// gnuplot.
[[nodiscard]] Drawing draw(const std::vector<Figure>& figures,
                           const std::vector<std::string>& formats);

}  // namespace a351::corrector
