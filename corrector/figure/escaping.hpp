#pragma once
/// @file
/// Conversion of text from outside (names of sites, notes) for pages and gnuplot scripts.
///
/// The text may have any bytes and any encoding.
///
///     node.text().set(clean_utf8(site).c_str());
///     command = "set title " + gnuplot_string(site);
///
/// The functions throw nothing but std::bad_alloc.  Examples: tests/unit/figure/escaping_test.cpp.

#include <string>
#include <string_view>

namespace a351::corrector::figure {

/// Returns the text as UTF-8 that XML allows on one line.  Each control character and each byte
/// that is not part of such a character becomes U+FFFD.
///
/// Tabulator and line end are control characters, and so are U+007F to U+009F.  Overlong forms,
/// surrogates and U+FFFE are not allowed either.  Valid text is returned unchanged, so a second
/// call changes nothing.
[[nodiscard]] std::string clean_utf8(std::string_view text);

/// Returns clean_utf8() cut to 20 characters, for a label of a figure; a longer text ends with an
/// ellipsis.  The ellipsis is the twentieth character.  Characters are code points: a letter with a
/// combining mark counts as two.
[[nodiscard]] std::string short_label(std::string_view text);

/// Returns clean_utf8() as a single-quoted string of gnuplot, in which backslash, backquote and @
/// have no special meaning.  An apostrophe becomes U+2019.  The manual's form, two apostrophes,
/// fails in gnuplot 5.4 at the start of a string.
/// @return the text with its quotation marks; an empty text gives ''.
[[nodiscard]] std::string gnuplot_string(std::string_view text);

}  // namespace a351::corrector::figure
