#pragma once
/// @file
/// Pieces of an HTML page that is well-formed XML too.  All text given is escaped here.

#include <string>
#include <string_view>
#include <vector>

namespace a351::corrector {

using HtmlCells = std::vector<std::string>;

/// @param alignment  a letter per column: l left, n left in one line, r right (numbers).
/// @param header     as many cells as letters, and so in every row.
[[nodiscard]] std::string html_table(std::string_view alignment, const HtmlCells& header,
                                     const std::vector<HtmlCells>& rows);

[[nodiscard]] std::string html_paragraph(std::string_view text);
[[nodiscard]] std::string html_list(const std::vector<std::string>& items);

/// The whole page.
/// @param body  HTML.
[[nodiscard]] std::string html_page(std::string_view title, std::string_view body);

}  // namespace a351::corrector
