#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace a351::daemon::config {

struct ListenAddress {
    std::string ip = "127.0.0.1";  ///< Numeric, without brackets.
    std::uint16_t port = 8351;     ///< 0: any free port.
    bool is_v6 = false;
    bool is_loopback = true;
};

/// Reads "127.0.0.1:8351", "[::1]:8351", "localhost:8351" and the like; std::nullopt if the text is
/// not an address.
[[nodiscard]] std::optional<ListenAddress> parse_listen(std::string_view text);

[[nodiscard]] std::string to_string(const ListenAddress& address);

/// Returns true if `text` can be a token: 16 or more visible ASCII characters.
[[nodiscard]] bool is_token(std::string_view text);

}  // namespace a351::daemon::config
