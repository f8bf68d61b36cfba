#pragma once
/// @file
/// Parts of an HTML page that is also well-formed XML.  The functions escape all text that they
/// take.
///
/// Parameters named `html` or `body`, and only these, are HTML that is escaped already.  All others
/// may be text from anywhere:
///
///     std::string body = "<h1>" + html_text(title) + "</h1>\n";  // html_text(): escaping.hpp
///     body += section("Stations", html_table(table_of(station_columns(), stations)));
///     const std::string page = html_page(title, body);
///
/// A page needs no other file: style and pictures are in it, and there is no script.

#include <string>
#include <string_view>
#include <vector>

#include "corrector/figure/drawing.hpp"
#include "corrector/result/table.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector::report {

/// Cells of a line of a table, as plain text.
using HtmlCells = std::vector<std::string>;

/// Returns a table.  One of more than twelve columns has smaller letters in print, to fit on A4.
/// @param alignment  a letter per column: l left, n left without line breaks, r right (numbers).
/// @param header     one cell per letter, like every row.
/// @param rows       lines in order; may be empty.  Cells beyond the letters are left out.
/// @throws std::out_of_range  the header or a row has fewer cells than there are letters.
[[nodiscard]] std::string html_table(std::string_view alignment, const HtmlCells& header,
                                     const std::vector<HtmlCells>& rows);

/// Returns a table for people, with degC as the degree sign and C.  This change concerns headings
/// only, once in each.
[[nodiscard]] std::string html_table(const result::Table& table);

/// Returns a paragraph.
[[nodiscard]] std::string html_paragraph(std::string_view text);
/// Returns a list with bullets; nothing without items.
[[nodiscard]] std::string html_list(const std::vector<std::string>& items);

/// Returns the pictures with their captions; small ones are side by side, after the others.
///
/// A figure without an SVG in `drawing` has a note that it is missing.  Each caption ends with the
/// name of the script, so that a reader finds it.
/// @param drawing  result of draw() for these and possibly other figures.  Call this function
///                 before add_figure_files(), which empties it.
[[nodiscard]] std::string figures_html(const std::vector<figure::Figure>& figures,
                                       const figure::Drawing& drawing);

/// Returns a section of a page, with its title as a heading of second order.
/// @param html  content, not escaped here.
[[nodiscard]] std::string section(std::string_view title, std::string_view html);

/// Returns the whole page: HTML 5 that is also well-formed XML, in UTF-8.
/// @param title  title of the window; the page shows a heading only if `body` has one.
/// @param body   HTML, not escaped here.
[[nodiscard]] std::string html_page(std::string_view title, std::string_view body);

/// Returns one line for all missing figures: the first reason and the number of others; none
/// without troubles.  The line is plain text, for the terminal and for html_list().
/// @param troubles  Drawing::troubles.
[[nodiscard]] std::vector<std::string> missing_lines(const std::vector<std::string>& troubles);

/// Adds figures/NAME.gp and .dat, then the pictures, which are moved out of `drawing`.
///
/// Afterwards the pictures in `drawing` must not be used.  A figure without data gets no .dat.
/// @param files  grows at its end; for text::write_together().
void add_figure_files(std::vector<text::NamedText>& files,
                      const std::vector<figure::Figure>& figures, figure::Drawing& drawing);

}  // namespace a351::corrector::report
