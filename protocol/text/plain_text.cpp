#include "protocol/text/plain_text.hpp"

#include <utf8proc.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

namespace a351::text {
namespace {

/// Returns the usual character for one that differs from it in width only.
utf8proc_int32_t usual(utf8proc_int32_t point, void*) {
    constexpr utf8proc_int32_t kNoBreakBlank = 0x00A0, kNarrowNoBreakBlank = 0x202F;
    constexpr utf8proc_int32_t kWideBlank = 0x3000;
    if (point == kNoBreakBlank || point == kNarrowNoBreakBlank || point == kWideBlank) return ' ';
    constexpr utf8proc_int32_t kFirstWide = 0xFF01, kLastWide = 0xFF5E;  // ! to ~
    return point >= kFirstWide && point <= kLastWide ? point - kFirstWide + '!' : point;
}

}  // namespace

bool is_ascii(std::string_view text) {
    return std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

std::string plain_text(std::string_view text) {
    if (is_ascii(text)) return std::string(text);
    utf8proc_uint8_t* result = nullptr;
    const auto length = utf8proc_map_custom(
        reinterpret_cast<const utf8proc_uint8_t*>(text.data()),
        static_cast<utf8proc_ssize_t>(text.size()), &result,
        static_cast<utf8proc_option_t>(UTF8PROC_STABLE | UTF8PROC_COMPOSE), usual, nullptr);
    const std::unique_ptr<utf8proc_uint8_t, decltype(&std::free)> owner(result, &std::free);
    if (length < 0) return std::string(text);
    return {reinterpret_cast<const char*>(result), static_cast<std::size_t>(length)};
}

}  // namespace a351::text
