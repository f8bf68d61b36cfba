#pragma once

#include <string>
#include <string_view>

namespace a351::text {

/// Returns true if a text is valid UTF-8.
[[nodiscard]] bool is_utf8(std::string_view text);

/// Returns true if a text has a character that nobody sees, or sees as a usual blank: a control
/// character, a no-break blank, a zero-width one.
[[nodiscard]] bool has_hidden_character(std::string_view text);

/// Returns text of an input file as an error line shows it: at most 100 bytes of it, then "..." and
/// its length.  Bytes that are not UTF-8 and control characters become \xHH.  A hidden character
/// becomes <U+00A0 no-break blank>; one that looks like another has such a name behind it, once.
[[nodiscard]] std::string echoed(std::string_view text);

}  // namespace a351::text
