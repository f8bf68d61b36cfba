#pragma once
/// @file
/// Access control.  Any page open in a browser of this host can send requests to a loopback
/// port, and after DNS rebinding it does so as the same origin.  Therefore Host and Origin are
/// compared with a list, never with each other, and a change needs a token that foreign pages
/// cannot read.  Pages of other daemons may do both if the configuration names them.  The numeric address to which the client connected is in the list, because
/// rebinding changes the address of a name, but cannot change an address.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/page/message.hpp"

namespace a351::daemon::page {

class Guard {
public:
    /// @param port   the server's port.
    /// @param hosts  names in addition to 127.0.0.1, localhost and [::1]; those without a port get
    ///               `port`.  An origin such as https://name is that of a proxy.  The ports 80 of
    ///               http and 443 of https may be left out, as browsers do.
    /// @param boxes  origins of the pages of other daemons, which may read answers and send changes.
    Guard(std::uint16_t port, const std::vector<std::string>& hosts, std::string token,
          const std::vector<std::string>& boxes = {});

    /// Returns the refusal, or std::nullopt for a request that may be answered:
    /// 421 Host missing, twice or not in the list;
    /// 403 Origin of another box, unless on the browser's own computer: /api/token, and all paths
    ///     outside of /api, because the pages have the token in them for a local client;
    /// 403 anything but GET and HEAD: Origin not in the list, content type not application/json,
    ///     or the header X-A351-Token missing or wrong;
    /// 403 GET with an upgrade to WebSocket (browsers allow it from any site): Origin not in list,
    ///     or no Origin and the token missing or wrong;
    /// 200 OPTIONS of a browser that asks whether a page of another box may send a request.
    [[nodiscard]] std::optional<Response> refuse(const Request& request) const;

    /// Lets a page of another box read an answer.
    void show_box(const Request& request, Response& response) const;

private:
    void add(std::string_view scheme, const std::string& host);
    [[nodiscard]] std::optional<std::string> box_of(const Request& request) const;
    [[nodiscard]] std::optional<Response> allow_box(const Request& request) const;

    std::vector<std::string> hosts_;    ///< Values of Host, lower case.
    std::vector<std::string> origins_;  ///< Values of Origin, lower case.
    std::vector<std::string> boxes_;    ///< Values of Origin of other boxes, lower case.
    std::string token_;
};

/// Returns 256 random bits from the kernel, in hexadecimal.
/// @throws std::system_error
[[nodiscard]] std::string random_token();

/// Returns the headers of every response.
[[nodiscard]] const std::vector<std::pair<std::string, std::string>>& security_headers();

}  // namespace a351::daemon::page
