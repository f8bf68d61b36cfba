#include "protocol/record/journal.hpp"

namespace a351::record {

namespace {

constexpr std::string_view kHexDigits = "0123456789abcdef";

}  // namespace

std::string SessionId::to_hex() const {
    std::string text;
    text.reserve(2 * bytes.size());
    for (const std::uint8_t byte : bytes) {
        text += kHexDigits[byte >> 4];
        text += kHexDigits[byte & 0xF];
    }
    return text;
}

std::optional<SessionId> SessionId::from_hex(std::string_view text) {
    SessionId id;
    if (text.size() != 2 * id.bytes.size()) return std::nullopt;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto digit = kHexDigits.find(text[i]);
        if (digit == std::string_view::npos) return std::nullopt;
        id.bytes[i / 2] = static_cast<std::uint8_t>(16u * id.bytes[i / 2] + digit);
    }
    return id;
}

bool is_same_stream(const JournalHeader& last, const JournalHeader& next) {
    return next.boot_id == last.boot_id && next.codes == last.codes &&
           next.profile == last.profile && next.output_rate_hz == last.output_rate_hz &&
           next.filter == last.filter && next.burst_ctrl == last.burst_ctrl &&
           next.baud == last.baud;
}

}  // namespace a351::record
