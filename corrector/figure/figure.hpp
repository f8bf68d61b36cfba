#pragma once
/// @file
/// A figure of the report as a gnuplot script with its data, so that an author can restyle it.
///
///     FigureData data("residuals");
///     const std::string points = data.add("hours residual_mgal", "1.0 0.3\n2.0 -0.1\n");
///     const Figure figure = data.figure("Residuals in time.", 640, 440,
///                                       "set xlabel 'Hours'\n" +
///                                           plot_command({points + " using 1:2 with points"}));
///
/// Add all blocks before the call of figure(), which copies them.  draw() of drawing.hpp turns
/// figures into pictures.  Nothing here starts a program or writes a file.

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace a351::corrector::figure {

/// A figure.  In the folder with its data, `gnuplot NAME.gp` writes NAME.svg, and
/// `gnuplot -e "format='pdf'" NAME.gp` writes NAME.pdf (or png).
///
/// A figure without data plots blocks of others, so that its script needs their NAME.dat in the
/// same folder.
struct Figure {
    std::string name;       ///< Stem of its files: small letters, digits, '-'.
    std::string caption;    ///< Plain text.
    std::string script;     ///< Content of NAME.gp.
    std::string data;       ///< Content of NAME.dat; empty if it plots the data of other figures.
    bool is_small = false;  ///< At most 480 pixels wide; two fit side by side on a page.
};

/// Okabe and Ito's colours, which colour-blind readers can distinguish too
/// (https://jfly.uni-koeln.de/color/).
inline const std::string kBlue = "'#0072B2'";
inline const std::string kVermilion = "'#D55E00'";
inline const std::string kGrey = "'#888888'";

/// Most points of a curve or scatter over a whole record.  Reason: a figure of weeks must stay
/// small.
inline constexpr std::size_t kMostPoints = 3000;

/// Returns the greatest of ... 0.2, 0.5, 1, 2, 5, 10 ... that is not above a limit > 0.  Use it for
/// the ticks of an axis: 0.73 gives 0.5, 999 gives 500 (figures_test.cpp).
/// @param limit  finite and > 0; not checked.
[[nodiscard]] double round_step(double limit);

/// Returns the number, or gnuplot's NaN, followed by a blank.  NaN and infinite values become NaN,
/// a point that gnuplot does not draw.
/// @param decimals  0 to 80, digits after the point.
[[nodiscard]] std::string datum(double value, int decimals);

/// The data of a figure: blocks of lines, numbered as gnuplot's `index` does.
///
/// An empty line within a block interrupts the curve.  Two empty lines would begin another block,
/// so they must not occur.
class FigureData {
public:
    /// @param name  of the figure.
    explicit FigureData(std::string name) : name_(std::move(name)) {}

    /// Adds a block.  An empty block is left out; then it must not be plotted.
    /// @param title  comment that names the columns; one line.
    /// @param lines  lines of the block, each with its line end; numbers from datum().
    /// @return `'NAME.dat' index BLOCK`, with which a clause begins; empty if `lines` is empty.
    std::string add(const std::string& title, const std::string& lines);

    /// Returns the figure of these data.  Its script resets the settings of earlier scripts,
    /// chooses the terminal by `format` (default svg), and sets the output and the common style.
    ///
    /// The terminal is `noenhanced`: `_`, `^` and braces in texts are shown as they are.  The
    /// figure is small if its width is at most 480 px.
    /// @param caption              plain text for the page; not part of the picture.
    /// @param width_px, height_px  size of the SVG at 96 per inch; PDF and PNG have its
    ///                             proportions.
    /// @param body                 the commands of the script.
    [[nodiscard]] Figure figure(const std::string& caption, int width_px, int height_px,
                                const std::string& body) const;

private:
    std::string name_;
    std::string text_;
    int count_ = 0;
};

/// Returns "plot A, \<newline> B, ..." from at least one clause.
/// @param clauses  as `'NAME.dat' index 0 using 1:2 with lines`; drawn in this order, so that later
///                 ones are above.
[[nodiscard]] std::string plot_command(const std::vector<std::string>& clauses);

}  // namespace a351::corrector::figure
