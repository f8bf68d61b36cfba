#include "corrector/figure/escaping.hpp"

#include <boost/locale/utf.hpp>

namespace a351::corrector::figure {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

/// Returns true for a character of XML that is no control character.
bool is_allowed(boost::locale::utf::code_point point) {
    return (point >= 0x20 && point <= 0x7E) || (point >= 0xA0 && point <= 0xFFFD) ||
           (point >= 0x10000 && point <= 0x10FFFF);
}

}  // namespace

std::string clean_utf8(std::string_view text) {
    std::string clean;
    const char* const end = text.data() + text.size();
    for (const char* at = text.data(); at != end;) {
        const char* next = at;
        if (is_allowed(boost::locale::utf::utf_traits<char>::decode(next, end))) {
            clean.append(at, next);
            at = next;
        } else {
            clean += kReplacement;
            ++at;
        }
    }
    return clean;
}

std::string short_label(std::string_view text) {
    constexpr std::size_t kLongest = 20;
    std::string label = clean_utf8(text);
    std::size_t count = 0, last = 0;
    for (std::size_t i = 0; i < label.size(); ++i) {
        if ((static_cast<unsigned char>(label[i]) & 0xC0U) == 0x80U) continue;
        if (++count == kLongest) last = i;
    }
    return count > kLongest ? label.substr(0, last) + "\xE2\x80\xA6" : label;  // U+2026
}

std::string gnuplot_string(std::string_view text) {
    std::string quoted = "'";
    for (const char c : clean_utf8(text))
        quoted += c == '\'' ? "\xE2\x80\x99" : std::string(1, c);  // U+2019
    return quoted + "'";
}

}  // namespace a351::corrector::figure
