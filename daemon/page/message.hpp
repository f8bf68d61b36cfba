#pragma once

#include <string>
#include <utility>
#include <vector>

namespace a351::daemon {

/// A complete HTTP request, independent of the network library.
struct Request {
    std::string method;
    std::string target;                                        ///< Path with query.
    std::vector<std::pair<std::string, std::string>> headers;  ///< Headers as received, in order.
    std::string body;

    /// Returns all values of the header `name`; upper and lower case are equal.
    [[nodiscard]] std::vector<std::string> values(std::string_view name) const;
};

struct Response {
    int status = 200;
    std::string content_type = "application/json";
    std::string body;
    std::vector<std::pair<std::string, std::string>> headers = {};
};

/// Returns `{"error": trouble}` with this status.
[[nodiscard]] Response refusal(int status, std::string_view trouble);

/// Joins keys for a refusal: "at, note", or "none".
[[nodiscard]] std::string joined(const std::vector<std::string>& keys);

}  // namespace a351::daemon
