#include "daemon/page/listen_address.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "protocol/core/input_error.hpp"

namespace a351::daemon {
namespace {

constexpr std::size_t kShortestToken = 16;  // 96 bits in base 64: not to be guessed over a network.

[[noreturn]] void refuse(std::string_view key, std::string_view value, std::string_view trouble) {
    throw InputError("[page] " + std::string(key) + " = \"" + std::string(value) +
                     "\": " + std::string(trouble));
}

std::optional<std::uint16_t> port_of(std::string_view digits) {
    std::uint16_t port = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
    if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
    return port;
}

}  // namespace

ListenAddress parse_listen(std::string_view listen, std::string_view token) {
    constexpr std::string_view kForm =
        "not an address and a port; allowed: \"127.0.0.1:8351\", \"[::1]:8351\" and the like";
    const auto colon = listen.rfind(':');
    if (colon == std::string_view::npos) refuse("listen", listen, kForm);
    const auto port = port_of(listen.substr(colon + 1));
    std::string host(listen.substr(0, colon));
    if (!port) refuse("listen", listen, kForm);
    if (host == "localhost") host = "127.0.0.1";

    ListenAddress address;
    address.port = *port;
    in_addr v4{};
    in6_addr v6{};
    if (host.size() > 2 && host.front() == '[' && host.back() == ']') {
        address.ip = host.substr(1, host.size() - 2);
        address.is_v6 = true;
        if (inet_pton(AF_INET6, address.ip.c_str(), &v6) != 1) refuse("listen", listen, kForm);
        address.is_loopback = IN6_IS_ADDR_LOOPBACK(&v6);
    } else {
        address.ip = host;
        if (inet_pton(AF_INET, host.c_str(), &v4) != 1) refuse("listen", listen, kForm);
        address.is_loopback = (ntohl(v4.s_addr) >> 24) == 127;
    }

    const bool is_visible =
        std::all_of(token.begin(), token.end(), [](char c) { return c > ' ' && c < '\x7f'; });
    if (!token.empty() && (token.size() < kShortestToken || !is_visible)) {
        refuse("token", "...", "allowed: 16 or more visible ASCII characters, or none");
    }
    if (!address.is_loopback && token.empty()) {
        refuse("listen", listen, "others can connect there, so a token must be set as well");
    }
    return address;
}

}  // namespace a351::daemon
