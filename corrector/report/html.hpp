#pragma once
/// @file
/// Parts of an HTML page that is also well-formed XML.  The functions escape all text that they
/// take.

#include <string>
#include <string_view>
#include <vector>

#include "corrector/figure/drawing.hpp"
#include "protocol/text/write_together.hpp"

namespace a351::corrector {

using HtmlCells = std::vector<std::string>;

/// Returns a table.
/// @param alignment  a letter per column: l left, n left without line breaks, r right (numbers).
/// @param header     one cell per letter, like every row.
[[nodiscard]] std::string html_table(std::string_view alignment, const HtmlCells& header,
                                     const std::vector<HtmlCells>& rows);

/// Returns a paragraph.
[[nodiscard]] std::string html_paragraph(std::string_view text);
/// Returns a list with bullets; nothing without items.
[[nodiscard]] std::string html_list(const std::vector<std::string>& items);

/// Returns the pictures with their captions; small ones are side by side, after the others.
[[nodiscard]] std::string figures_html(const std::vector<Figure>& figures, const Drawing& drawing);

/// Returns a section of a page.
/// @param html  content, not escaped here.
[[nodiscard]] std::string section(std::string_view title, std::string_view html);

/// Returns the whole page.
/// @param body  HTML, not escaped here.
[[nodiscard]] std::string html_page(std::string_view title, std::string_view body);

/// Returns one line for all missing figures: the first reason and the number of others; none
/// without troubles.
[[nodiscard]] std::vector<std::string> missing_lines(const std::vector<std::string>& troubles);

/// Adds figures/NAME.gp and .dat, then the pictures, which are moved out of `drawing`.
void add_figure_files(std::vector<text::NamedText>& files, const std::vector<Figure>& figures,
                      Drawing& drawing);

}  // namespace a351::corrector
