#pragma once
/// @file
/// Values that may be absent, as JSON.
///
///     json["u_mgal"] = or_null(row.u);       // a number, or null
///     json["key"] = or_null(stay.key);       // a text, or null if it is empty

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace a351::text {

/// Returns the value as JSON, a quantity in its own unit; null without a value.
template <class Value>
[[nodiscard]] nlohmann::ordered_json or_null(const std::optional<Value>& value) {
    if (!value) return nullptr;
    if constexpr (requires { value->value(); }) {
        return value->value();
    } else {
        return *value;
    }
}

/// Returns the text as JSON; null if it is empty.
[[nodiscard]] inline nlohmann::ordered_json or_null(const std::string& text) {
    return text.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(text);
}

}  // namespace a351::text
