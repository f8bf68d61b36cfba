#include "protocol/text/columns.hpp"

namespace a351::text {
namespace {

/// Returns the columns of a letter that begins with this byte of UTF-8; 0 within a letter.
std::size_t columns_of_letter(unsigned char byte) {
    constexpr unsigned char kFirstWide = 0xE3;  // U+3000
    if ((byte & 0xC0U) == 0x80) return 0;
    return byte >= kFirstWide ? 2 : 1;
}

}  // namespace

std::size_t columns_of(std::string_view text) {
    std::size_t columns = 0;
    for (const char c : text) columns += columns_of_letter(static_cast<unsigned char>(c));
    return columns;
}

}  // namespace a351::text
