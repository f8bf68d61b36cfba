#pragma once

#include <cstddef>
#include <string_view>

namespace a351::text {

/// Returns the columns of a text in UTF-8 on a terminal.  Letters from U+3000 on count as two.
[[nodiscard]] std::size_t columns_of(std::string_view text);

}  // namespace a351::text
