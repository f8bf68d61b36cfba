#include "corrector/figure/print_style.hpp"

namespace a351::corrector::figure {
namespace {

/// Returns the width of a letter that begins with this byte of UTF-8, as a share of its size; 0
/// within a letter.  Source: advance widths of DejaVu Sans 2.37, for most letters
/// of a kind; single ones are up to a tenth wider, = and the minus sign a third.
double width_of(unsigned char byte) {
    constexpr std::string_view kNarrow = " .,:;'|()[]ijltfrI", kWide = "mwMW";
    constexpr unsigned char kFirstJapanese = 0xE3;  // U+3000
    if ((byte & 0xC0U) == 0x80U) return 0.0;
    if (byte >= kFirstJapanese) return 1.0;
    if (kNarrow.find(static_cast<char>(byte)) != std::string_view::npos) return 0.38;
    if (kWide.find(static_cast<char>(byte)) != std::string_view::npos) return 0.95;
    return byte >= 'A' && byte <= 'Z' ? 0.72 : 0.63;
}

}  // namespace

double text_width_mm(std::string_view text, double letters_pt) {
    double width = 0.0;
    for (const char c : text) width += width_of(static_cast<unsigned char>(c));
    return width * letters_pt * kMmPerInch / kPointsPerInch;
}

}  // namespace a351::corrector::figure
