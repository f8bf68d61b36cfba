#pragma once
/// @file
/// Text from outside (names of sites, notes) on its way into HTML and gnuplot scripts.

#include <string>
#include <string_view>

namespace a351::corrector {

/// The text as UTF-8 that XML allows on one line: every other byte and every control character
/// becomes U+FFFD.
[[nodiscard]] std::string clean_utf8(std::string_view text);

/// clean_utf8() of at most 20 characters, for a label of a figure; a longer text ends with an
/// ellipsis.
[[nodiscard]] std::string short_label(std::string_view text);

/// clean_utf8() with & < > " ' as character references: for element content and attributes.
[[nodiscard]] std::string html_text(std::string_view text);

/// clean_utf8() as a single-quoted string of gnuplot, in which neither backslash nor backquote nor
/// @ means anything.  An apostrophe becomes U+2019: written twice, as the manual has it, gnuplot
/// 5.4 does not read it at the start of a string.
[[nodiscard]] std::string gnuplot_string(std::string_view text);

}  // namespace a351::corrector
