#pragma once
/// @file
/// From figures to pictures, by gnuplot.
///
/// gnuplot is a separate program that is found in PATH.  A missing or failing gnuplot is no error
/// here: the pictures are missing, and the reasons are in the result.  Scripts and data of the
/// figures are useful without it.
///
///     const Drawing drawing = draw(figures, {"pdf"});
///     for (const std::string& trouble : drawing.troubles) std::cerr << trouble << '\n';

#include <string>
#include <vector>

#include "corrector/figure/figure.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector::figure {

/// Returns the formats of pictures other than SVG: "pdf", a vector format for papers, and "png",
/// 300 dots per inch.  The list lives as long as the program.
[[nodiscard]] const std::vector<std::string>& picture_formats();

/// How figures are wanted: formats besides SVG, from picture_formats(), and their width.
struct FigureOptions {
    std::vector<std::string> formats = {};
    Print print = {};
};

/// The pictures that could be drawn.  SVG is first, then the other formats in the order asked for.
///
/// No troubles: every figure has every format.  A trouble of one figure begins with its
/// NAME.FORMAT.  If gnuplot is missing or exceeds its time limit, there is one trouble for the
/// whole format.
struct Drawing {
    std::vector<text::NamedText>
        pictures;                       ///< NAME.FORMAT; of each format, in the order of figures.
    std::vector<std::string> troubles;  ///< Reasons for missing pictures; one line each.
};

/// Draws all figures, in a temporary folder.
///
/// One process draws all figures of a format.  If it fails, each figure is drawn alone, so that one
/// bad figure does not affect the others.  The same figures give the same bytes with the same
/// gnuplot (drawing_test.cpp).  The date in a PDF is replaced by 1970-01-01.
///
/// A run of gnuplot is killed after 60 s; its figures are then not drawn alone.  It gets no shell,
/// the locale C.UTF-8 and UTC as its time zone.  The temporary folder is below
/// std::filesystem::temp_directory_path() and is removed at the end.  A folder or a file that cannot
/// be written there is a trouble too.
/// @param figures  with different names; a figure without data may plot the data of the others.  No
///                 figures give an empty result, and no program is started.
/// @param formats  formats besides SVG, from picture_formats(); not checked.
[[nodiscard]] Drawing draw(const std::vector<Figure>& figures,
                           const std::vector<std::string>& formats);

}  // namespace a351::corrector::figure
