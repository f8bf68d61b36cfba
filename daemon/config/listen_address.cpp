#include "daemon/config/listen_address.hpp"

#include <arpa/inet.h>
#include <fmt/core.h>

#include <algorithm>

#include "protocol/core/whole_number.hpp"

namespace a351::daemon::config {
namespace {

constexpr std::size_t kShortestToken = 16;  // 96 bits in base 64 cannot be guessed over a network.

}  // namespace

std::optional<ListenAddress> parse_listen(std::string_view text) {
    const auto colon = text.rfind(':');
    if (colon == std::string_view::npos) return std::nullopt;
    const auto port = parse_whole<std::uint16_t>(text.substr(colon + 1));
    if (!port) return std::nullopt;

    ListenAddress address;
    address.port = *port;
    address.ip = text.substr(0, colon);
    if (address.ip == "localhost") address.ip = "127.0.0.1";
    in_addr v4{};
    in6_addr v6{};
    if (address.ip.size() > 2 && address.ip.front() == '[' && address.ip.back() == ']') {
        address.ip = address.ip.substr(1, address.ip.size() - 2);
        address.is_v6 = true;
        if (inet_pton(AF_INET6, address.ip.c_str(), &v6) != 1) return std::nullopt;
        address.is_loopback = IN6_IS_ADDR_LOOPBACK(&v6);
    } else {
        if (inet_pton(AF_INET, address.ip.c_str(), &v4) != 1) return std::nullopt;
        address.is_loopback = (ntohl(v4.s_addr) >> 24) == 127;
    }
    return address;
}

std::string to_string(const ListenAddress& address) {
    return address.is_v6 ? fmt::format("[{}]:{}", address.ip, address.port)
                         : fmt::format("{}:{}", address.ip, address.port);
}

bool is_token(std::string_view text) {
    return text.size() >= kShortestToken &&
           std::ranges::all_of(text, [](char c) { return c > ' ' && c < '\x7f'; });
}

}  // namespace a351::daemon::config
