#include "corrector/figure/escaping.hpp"

#include <array>

namespace a351::corrector::figure {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

/// A length of character: its lead byte, and the code points of this length.
struct Form {
    unsigned lead_mask, lead;
    std::size_t size;
    char32_t least, greatest;
};
constexpr std::array<Form, 4> kForms{{
    {0x80, 0x00, 1, 0x20, 0x7E},  // no control character
    {0xE0, 0xC0, 2, 0xA0, 0x7FF},
    {0xF0, 0xE0, 3, 0x800, 0xFFFD},  // XML excludes U+FFFE and U+FFFF
    {0xF8, 0xF0, 4, 0x10000, 0x10FFFF},
}};

/// Returns the number of bytes of the character at the start of `text`; 0 if there is no allowed
/// one.
std::size_t character_size(std::string_view text) {
    const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    for (const Form& form : kForms) {
        if ((byte(0) & form.lead_mask) != form.lead) continue;
        if (text.size() < form.size) return 0;
        char32_t code = byte(0) & ~form.lead_mask & 0xFFU;
        for (std::size_t i = 1; i < form.size; ++i) {
            if ((byte(i) & 0xC0U) != 0x80U) return 0;
            code = code << 6U | (byte(i) & 0x3FU);
        }
        const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
        return code >= form.least && code <= form.greatest && !is_surrogate ? form.size : 0;
    }
    return 0;
}

}  // namespace

std::string clean_utf8(std::string_view text) {
    std::string clean;
    while (!text.empty()) {
        const std::size_t size = character_size(text);
        clean += size == 0 ? kReplacement : text.substr(0, size);
        text.remove_prefix(size == 0 ? 1 : size);
    }
    return clean;
}

std::string short_label(std::string_view text) {
    constexpr std::size_t kLongest = 20;
    const std::string clean = clean_utf8(text);
    std::string label;
    std::size_t count = 0;
    for (std::string_view rest = clean; !rest.empty(); ++count) {
        const std::size_t size = character_size(rest);
        if (count == kLongest - 1 && size < rest.size()) return label + "\xE2\x80\xA6";  // U+2026
        label += rest.substr(0, size);
        rest.remove_prefix(size);
    }
    return label;
}

std::string gnuplot_string(std::string_view text) {
    std::string quoted = "'";
    for (const char c : clean_utf8(text)) {
        quoted += c == '\'' ? "\xE2\x80\x99" : std::string(1, c);  // U+2019
    }
    return quoted + "'";
}

}  // namespace a351::corrector::figure
