#pragma once
/// @file
/// Parts of an HTML page that is also well-formed XML.  The functions escape all text that they
/// take.

#include <string>
#include <string_view>
#include <vector>

namespace a351::corrector {

using HtmlCells = std::vector<std::string>;

/// Returns a table.
/// @param alignment  a letter per column: l left, n left without line breaks, r right (numbers).
/// @param header     one cell per letter, like every row.
[[nodiscard]] std::string html_table(std::string_view alignment, const HtmlCells& header,
                                     const std::vector<HtmlCells>& rows);

/// Returns a paragraph.
[[nodiscard]] std::string html_paragraph(std::string_view text);
/// Returns a list with bullets.
[[nodiscard]] std::string html_list(const std::vector<std::string>& items);

/// Returns the whole page.
/// @param body  HTML, not escaped here.
[[nodiscard]] std::string html_page(std::string_view title, std::string_view body);

}  // namespace a351::corrector
