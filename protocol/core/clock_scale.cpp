#include "protocol/core/clock_scale.hpp"

#include <charconv>

namespace a351 {

UtcTime ClockScale::simulated(UtcTime host_now) const {
    return utc + from_seconds(factor * seconds_between(host, host_now));
}

UtcTime ClockScale::host_at(UtcTime simulated_time) const {
    return host + from_seconds(seconds_between(utc, simulated_time) / factor);
}

std::optional<ClockScale> parse_clock_scale(std::string_view text, UtcTime host_now) {
    constexpr std::string_view kPrefix = "scaled:";
    if (!text.starts_with(kPrefix)) return std::nullopt;
    text.remove_prefix(kPrefix.size());
    const std::size_t at = text.find('@');
    if (at == std::string_view::npos) return std::nullopt;

    double factor = 0.0;
    const char* const factor_end = text.data() + at;
    const auto parsed = std::from_chars(text.data(), factor_end, factor);
    if (parsed.ec != std::errc() || parsed.ptr != factor_end) return std::nullopt;
    if (!(factor > 0.0 && factor <= 1e6)) return std::nullopt;

    text.remove_prefix(at + 1);
    const std::size_t comma = text.find(',');
    const auto utc = parse_rfc3339(text.substr(0, comma));
    const auto host = comma == std::string_view::npos ? std::optional(host_now)
                                                      : parse_rfc3339(text.substr(comma + 1));
    if (!utc || !host) return std::nullopt;
    return ClockScale{factor, *utc, *host};
}

}  // namespace a351
