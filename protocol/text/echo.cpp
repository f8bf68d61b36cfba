#include "protocol/text/echo.hpp"

#include <fmt/core.h>

#include <boost/locale/utf.hpp>

namespace a351::text {
namespace {

constexpr std::size_t kMostEchoed = 100;  // bytes; longer than any key, name or number

bool is_visible(boost::locale::utf::code_point point) {
    if (point == boost::locale::utf::illegal || point == boost::locale::utf::incomplete)
        return false;
    // U+0080 to U+009F are control characters too.
    return point >= 0x20 && (point < 0x7F || point > 0x9F);
}

}  // namespace

bool is_utf8(std::string_view text) {
    using boost::locale::utf::code_point;
    for (const char* at = text.data(); at != text.data() + text.size();) {
        const code_point point =
            boost::locale::utf::utf_traits<char>::decode(at, text.data() + text.size());
        if (point == boost::locale::utf::illegal || point == boost::locale::utf::incomplete)
            return false;
    }
    return true;
}

std::string echoed(std::string_view text) {
    std::string shown;
    const char* const end = text.data() + text.size();
    for (const char* at = text.data(); at != end;) {
        const auto taken = static_cast<std::size_t>(at - text.data());
        if (taken >= kMostEchoed) return fmt::format("{}... ({} bytes)", shown, text.size());
        const char* next = at;
        if (is_visible(boost::locale::utf::utf_traits<char>::decode(next, end))) {
            shown.append(at, next);
            at = next;
        } else {
            shown += fmt::format("\\x{:02X}", static_cast<unsigned char>(*at++));
        }
    }
    return shown;
}

}  // namespace a351::text
