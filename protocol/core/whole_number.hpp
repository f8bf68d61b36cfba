#pragma once

#include <charconv>
#include <concepts>
#include <optional>
#include <string_view>
#include <system_error>

namespace a351 {

/// Returns the whole number that a text is, in decimal digits, for a signed type with '-' before them;
/// std::nullopt for any other text or a number beyond the type.
template <std::integral Whole>
[[nodiscard]] std::optional<Whole> parse_whole(std::string_view text) {
    Whole value{};
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, value);
    return error == std::errc() && end == last ? std::optional(value) : std::nullopt;
}

}  // namespace a351
