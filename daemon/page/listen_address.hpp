#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace a351::daemon {

struct ListenAddress {
    std::string ip;  ///< Numeric, without brackets.
    bool is_v6 = false;
    bool is_loopback = true;
    std::uint16_t port = 8351;  ///< 0: any free one.
};

/// Reads `[page] listen` ("127.0.0.1:8351", "[::1]:8351", "localhost:8351") and applies its rule:
/// beyond loopback a token is needed.  A token is 16 or more visible ASCII characters.
/// @throws InputError  naming key, value and what is allowed.
[[nodiscard]] ListenAddress parse_listen(std::string_view listen, std::string_view token);

}  // namespace a351::daemon
