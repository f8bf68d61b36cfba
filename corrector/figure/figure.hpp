#pragma once
/// @file
/// A figure as data: panels with axes, series, spans, lines and texts.
///
///     Figure figure{"residuals", "Residuals in time.", print.wide_mm()};
///     figure.panels = {{.x = {"Hours"}, .y = {"Residual (mGal)"}}};
///     figure.plot("hours residual_mgal", data_line("11", {1.0, 0.3}), {Look::discs});
///
/// It says what is shown.  print_style.hpp has the sizes of letters and lines, layout.hpp decides the
/// places, gnuplot_script.hpp writes the script, and draw() of drawing.hpp makes the pictures.

#include <array>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "corrector/figure/print_style.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector::figure {

/// Eight colours of Okabe and Ito, which colour-blind readers can distinguish too
/// (https://jfly.uni-koeln.de/color/); greys of error bars, raw samples and the way from station to
/// station; tints of an area between limits, of a stay, a stay without a value and an averaged
/// interval; and a colour by the value of the last column, which is on Panel::colours.
// clang-format off
enum class Colour {
    blue, vermilion, green, orange, sky, purple, black, grey, bar_grey, raw_grey, route_grey,
    limits, stay, lost_stay, averaged, by_value
};

/// Look of a series.  Its columns are x and y, except:
/// - bars and the looks with bars: x, y and u, or x, y, low and high;
/// - area: x, low and high;
/// - tiles: x, y, the least and the greatest x, the least and the greatest y, and the value.
///
/// Lines are interrupted by an empty line of the data.  Boxes are from 0 to y.  Curves of one panel
/// differ in look too, so that they can be distinguished in grey.
enum class Look {
    line, thin_line, strong_line, dashed_line, dotted_line, ribbon, area, boxes, tiles, bars,
    dots, discs, small_discs, crosses, diamonds, open_diamonds, large_discs, triangles,
    linked_discs, linked_triangles, linked_squares,
    discs_with_bars, circles_with_bars, triangles_with_bars, diamonds_with_bars
};
// clang-format on

/// Source of the line y = 0, which needs no data.
inline const std::string kZero = "0";

struct Series {
    Look look = Look::line;
    Colour colour = Colour::blue;
    std::string label = {};  ///< In the key; empty: not there.
    /// Numbers of the columns, from 1.  Expressions of gnuplot would cost more time than all the rest
    /// of a survey's figures, because each value is two system calls.
    std::vector<int> columns = {1, 2};
    std::string source = {};  ///< Figure::add(), source_of() or kZero.
    bool is_right = false;    ///< Its y axis is the right one.
};

/// The end of a range that follows from the data.
inline constexpr double kFromData = std::numeric_limits<double>::quiet_NaN();

enum class Scale { linear, logarithmic, time };

struct Axis {
    std::string label = {};
    std::array<double, 2> range = {kFromData, kFromData};
    double step = 0.0;           ///< Distance of the ticks; 0: a round number.
    std::string format = "% h";  ///< Of the numbers at the ticks, as of printf.
    Scale scale = Scale::linear;
    std::vector<std::pair<double, std::string>> names = {};  ///< Ticks with names instead.
    bool is_shown = true;                                    ///< It has ticks.
};

/// A place: shares of the panel's width and height; x may be a value of its axis instead.
struct Place {
    double x = 0.0, y = 0.0;
    bool is_x_value = false;
};

struct Text {
    std::string text;  ///< May have several lines.
    Place place;
    std::string side = "left";  ///< Its end at the place: left, center, right.
};

enum class Stroke { dashed, scale_bar, pointer };

struct Line {
    Place from, to;
    Stroke stroke = Stroke::dashed;
};

/// A shaded part of the x axis.
struct Span {
    double from = 0.0, to = 0.0;
    Colour colour = Colour::stay;
};

/// A panel.  No text is rotated and nothing is drawn over a curve.  The label of the y axis is
/// above the panel at the left, that of the right axis or of the colours at the right.  The key is
/// below them.
struct Panel {
    Axis x = {}, y = {};
    std::vector<Series> series = {};
    Axis right = {.is_shown = false}, colours = {};
    std::vector<Span> spans = {};
    std::vector<Line> lines = {};
    std::vector<Text> texts = {};
    /// Names above places of the x axis, whose range must be known, in ascending order.
    std::vector<std::pair<double, std::string>> names = {};
    std::string heading = {};  ///< At the left, in a figure of several columns.
    std::string note = {};     ///< At the right, without a right axis and colours.
    bool has_margin = false;   ///< There is room between the outer points and the border.
    double height_mm = kSmallPanel_mm;
};

/// A figure.  In the folder with its data, `gnuplot NAME.gp` writes NAME.svg, and
/// `gnuplot -e "format='pdf'" NAME.gp` writes NAME.pdf (or png).
///
/// A figure without data plots blocks of others, so that its script needs their NAME.dat in the
/// same folder.
struct Figure {
    std::string name;          ///< Stem of its files: small letters, digits, '-'.
    std::string caption = {};  ///< Plain text.
    double width_mm = kPage_mm;
    std::vector<Panel> panels = {};
    std::size_t columns = 1;      ///< Panels side by side.
    bool has_common_y = true;     ///< They share their y axis.
    std::string data = {};        ///< Content of NAME.dat.
    std::size_t block_count = 0;  ///< Blocks in it.

    /// Adds a block to the data.
    /// @param title  comment that names the columns; one line.
    /// @param lines  lines of the block, each with its line end; numbers from data_line().  An empty
    ///               line interrupts a curve.  Two empty lines would begin another block.
    /// @return the source of a series; empty if `lines` is empty.
    std::string add(const std::string& title, const std::string& lines);

    /// Adds a block, and a series of it to a panel; nothing if `lines` is empty.
    void plot(const std::string& title, const std::string& lines, Series series,
              std::size_t panel = 0);

    /// Returns true if two such figures fit side by side on a page.
    [[nodiscard]] bool is_small() const { return width_mm <= kColumn_mm; }
};

/// Returns the source of a series that plots a block of a figure's data.
[[nodiscard]] std::string source_of(const std::string& figure, std::size_t block);

/// Returns a line of the data: each number followed by a blank, then the end of the line.  NaN and
/// infinite values become gnuplot's NaN, a point that it does not draw.
/// @param decimals  for each number a digit, its digits after the point.
[[nodiscard]] std::string data_line(std::string_view decimals,
                                    std::initializer_list<double> numbers,
                                    const std::string& end = "\n");

/// Returns the value of an instant on an axis of time: seconds since 1970.
[[nodiscard]] double instant(UtcTime time);

/// Returns the end of a caption that names the publication's figure, and its value of what the
/// figure shows.
/// @param value  only if it is the same quantity, else empty.
[[nodiscard]] std::string as_published(const std::string& number, const std::string& value = "");

/// Returns the end of a caption that lists the names for which a figure has no room, each once; empty
/// without names.
[[nodiscard]] std::string without_room(const std::vector<std::string>& names);

/// Most points of a curve or scatter over a whole record.  Reason: a figure of weeks must stay
/// small.
inline constexpr std::size_t kMostPoints = 3000;

/// Returns the greatest of ... 0.2, 0.5, 1, 2, 5, 10 ... that is not above a limit > 0.  Use it for
/// the ticks of an axis: 0.73 gives 0.5, 999 gives 500 (figures_test.cpp).
/// @param limit  finite and > 0; not checked.
[[nodiscard]] double round_step(double limit);

}  // namespace a351::corrector::figure
