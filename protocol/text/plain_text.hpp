#pragma once

#include <string>
#include <string_view>

namespace a351::text {

/// Returns text in the one form in which names are compared and numbers are read: Unicode's
/// normalization form C, so that an accent or voice mark is one character with its letter; no-break
/// and wide blanks as usual blanks; the wide forms of ASCII (U+FF01 to U+FF5E) as ASCII.
///
/// Nobody sees a difference in meaning between these forms.  Nothing else changes, and text that is
/// not UTF-8 stays as it is.
[[nodiscard]] std::string plain_text(std::string_view text);

/// Returns true if all characters are ASCII: plain_text() would return the same text.
[[nodiscard]] bool is_ascii(std::string_view text);

}  // namespace a351::text
