#pragma once

#include <string_view>

namespace a351::text {

/// Returns the Japanese catalogue as msgfmt compiles it, a .mo file.
[[nodiscard]] std::string_view compiled_catalogue() noexcept;

}  // namespace a351::text
