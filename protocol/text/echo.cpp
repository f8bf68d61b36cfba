#include "protocol/text/echo.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/locale/utf.hpp>
#include <iterator>

namespace a351::text {
namespace {

constexpr std::size_t kMostEchoed = 100;  // bytes; longer than any key, name or number

using boost::locale::utf::code_point;

/// Characters that a reader takes for others.
struct Unusual {
    code_point first, last;
    bool is_hidden;
    const char* name;
};

constexpr Unusual kUnusual[] = {
    {0x00A0, 0x00A0, true, "no-break blank"},
    {0x00AD, 0x00AD, true, "invisible"},
    {0x0300, 0x036F, false, "accent apart from its letter"},
    {0x2000, 0x200A, true, "unusual blank"},
    {0x200B, 0x200F, true, "invisible"},
    {0x2010, 0x2015, false, "dash, not -"},
    {0x2018, 0x201F, false, "curly quotation mark"},
    {0x2028, 0x202E, true, "invisible"},
    {0x202F, 0x202F, true, "no-break blank"},
    {0x205F, 0x205F, true, "unusual blank"},
    {0x2060, 0x2064, true, "invisible"},
    {0x2212, 0x2212, false, "minus sign, not -"},
    {0x3000, 0x3000, false, "wide blank"},
    {0x3099, 0x309A, false, "voice mark apart from its letter"},
    {0xFEFF, 0xFEFF, true, "invisible"},
    {0xFF0B, 0xFF19, false, "wide"},
};

const Unusual* unusual(code_point point) {
    const auto* const found = std::ranges::find_if(
        kUnusual, [&](const Unusual& one) { return one.first <= point && point <= one.last; });
    return found == std::end(kUnusual) ? nullptr : found;
}

bool is_control(code_point point) {
    // U+0080 to U+009F are control characters too.
    return point < 0x20 || (point >= 0x7F && point <= 0x9F);
}

bool is_valid(code_point point) {
    return point != boost::locale::utf::illegal && point != boost::locale::utf::incomplete;
}

/// Returns the next character and moves `at` behind it.
code_point decode(const char*& at, const char* end) {
    return boost::locale::utf::utf_traits<char>::decode(at, end);
}

}  // namespace

bool is_utf8(std::string_view text) {
    const char* const end = text.data() + text.size();
    for (const char* at = text.data(); at != end;)
        if (!is_valid(decode(at, end))) return false;
    return true;
}

bool has_hidden_character(std::string_view text) {
    const char* const end = text.data() + text.size();
    for (const char* at = text.data(); at != end;) {
        const code_point point = decode(at, end);
        const Unusual* const kind = unusual(point);
        if (is_control(point) || (kind != nullptr && kind->is_hidden)) return true;
    }
    return false;
}

std::string echoed(std::string_view text) {
    std::string shown;
    const char* const end = text.data() + text.size();
    const Unusual* named = nullptr;
    for (const char* at = text.data(); at != end;) {
        const auto taken = static_cast<std::size_t>(at - text.data());
        if (taken >= kMostEchoed) return fmt::format("{}... ({} bytes)", shown, text.size());
        const char* next = at;
        const code_point point = decode(next, end);
        if (!is_valid(point) || is_control(point)) {
            shown += fmt::format("\\x{:02X}", static_cast<unsigned char>(*at++));
            continue;
        }
        const Unusual* const kind = unusual(point);
        if (kind == nullptr || !kind->is_hidden) shown.append(at, next);
        if (kind != nullptr && (kind->is_hidden || kind != named))
            shown += fmt::format("<U+{:04X} {}>", point, kind->name);
        if (kind != nullptr) named = kind;
        at = next;
    }
    return shown;
}

}  // namespace a351::text
