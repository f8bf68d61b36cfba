#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace a351::text {

/// Returns JSON as text.  Names from files and devices may be in any encoding: what is not UTF-8 becomes
/// U+FFFD.
/// @param indent  spaces of a level; -1: all in one line.
template <class Json>
[[nodiscard]] std::string json_text(const Json& json, int indent = -1) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace a351::text
