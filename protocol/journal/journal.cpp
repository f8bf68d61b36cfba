#include "protocol/journal/journal.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace a351::journal {

std::string SessionId::to_hex() const {
    std::string text;
    for (const std::uint8_t byte : bytes) text += fmt::format("{:02x}", byte);
    return text;
}

std::optional<SessionId> SessionId::from_hex(std::string_view text) {
    constexpr std::string_view kHexDigits = "0123456789abcdef";
    SessionId id;
    if (text.size() != 2 * id.bytes.size()) return std::nullopt;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto digit = kHexDigits.find(text[i]);
        if (digit == std::string_view::npos) return std::nullopt;
        id.bytes[i / 2] = static_cast<std::uint8_t>(std::size_t{id.bytes[i / 2]} << 4 | digit);
    }
    return id;
}

bool are_valid(const StationCodes& codes) noexcept {
    const auto is_code = [](const std::string& code, std::size_t shortest, std::size_t longest) {
        return code.size() >= shortest && code.size() <= longest &&
               std::ranges::all_of(
                   code, [](char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); });
    };
    return is_code(codes.network, 1, 2) && is_code(codes.station, 1, 5) &&
           (codes.location.empty() || is_code(codes.location, 2, 2)) &&
           std::ranges::all_of(codes.axes, [&](const auto& axis) { return is_code(axis, 1, 1); });
}

bool is_in_range(const timing::ClockReading& clock) noexcept {
    const auto is_instant = [](Nanoseconds time) {
        return kEarliestInstant <= time && time <= kLatestInstant;
    };
    const auto is_error = [](std::int64_t error_us) {
        return -kMostClockError_us <= error_us && error_us <= kMostClockError_us;
    };
    return is_instant(clock.raw.time_since_epoch()) && is_instant(clock.boottime) &&
           is_instant(clock.realtime.time_since_epoch()) && is_error(clock.max_error_us) &&
           is_error(clock.estimated_error_us);
}

bool is_same_stream(const Header& last, const Header& next) {
    return next.boot_id == last.boot_id && next.codes == last.codes &&
           next.profile == last.profile && next.output_rate_hz == last.output_rate_hz &&
           next.filter == last.filter && next.burst_ctrl == last.burst_ctrl &&
           next.baud == last.baud;
}

}  // namespace a351::journal
