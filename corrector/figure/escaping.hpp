#pragma once
/// @file
/// Conversion of text from outside (names of sites, notes) for HTML and gnuplot scripts.

#include <string>
#include <string_view>

namespace a351::corrector {

/// Returns the text as UTF-8 that XML allows on one line.  Each control character and each byte
/// that is not part of such a character becomes U+FFFD.
[[nodiscard]] std::string clean_utf8(std::string_view text);

/// Returns clean_utf8() cut to 20 characters, for a label of a figure; a longer text ends with an
/// ellipsis.
[[nodiscard]] std::string short_label(std::string_view text);

/// Returns clean_utf8() with & < > " ' as character references, for element content and attributes.
[[nodiscard]] std::string html_text(std::string_view text);

/// Returns clean_utf8() as a single-quoted string of gnuplot, in which backslash, backquote and @
/// have no special meaning.  An apostrophe becomes U+2019.  The manual's form, two apostrophes,
/// fails in gnuplot 5.4 at the start of a string.
[[nodiscard]] std::string gnuplot_string(std::string_view text);

}  // namespace a351::corrector
