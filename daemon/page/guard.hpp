#pragma once
/// @file
/// Who may ask.  Any page open in a browser of this host can send requests to a loopback port, and
/// after DNS rebinding it does so as the same origin; so Host and Origin are compared with a list,
/// never with each other, and a change needs a token that no foreign page can read.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/page/message.hpp"

namespace a351::daemon {

class Guard {
public:
    /// @param port   the one listened on.
    /// @param hosts  names beyond 127.0.0.1, localhost and [::1]; without a port they get `port`.
    Guard(std::uint16_t port, const std::vector<std::string>& hosts, std::string token);

    /// The refusal, or std::nullopt for a request that may be answered:
    /// 421 Host missing, twice or not in the list;
    /// 403 anything but GET and HEAD: Origin not in the list, content type not application/json,
    ///     or the header X-A351-Token missing or wrong;
    /// 403 GET with an upgrade to WebSocket, which no rule of the browser keeps from other sites:
    ///     Origin not in the list, or none and the token missing or wrong.
    [[nodiscard]] std::optional<Response> refuse(const Request& request) const;

    [[nodiscard]] const std::string& token() const noexcept { return token_; }

private:
    std::vector<std::string> hosts_;  ///< name:port, lower case.
    std::string token_;
};

/// 256 random bits from the kernel, in hexadecimal.
/// @throws std::system_error
[[nodiscard]] std::string random_token();

/// Takes a time that does not depend on where the texts differ.
[[nodiscard]] bool is_same_secret(std::string_view given, std::string_view expected) noexcept;

/// Headers of every response.
[[nodiscard]] const std::vector<std::pair<std::string, std::string>>& security_headers();

}  // namespace a351::daemon
