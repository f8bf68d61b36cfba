#pragma once

#include <string>
#include <utility>
#include <vector>

namespace a351::daemon {

/// A complete HTTP request, as the pure part of the page sees it.
struct Request {
    std::string method;
    std::string target;                                        ///< Path with query.
    std::vector<std::pair<std::string, std::string>> headers;  ///< As received, in order.
    std::string body;

    /// All values of the header `name`, which is compared without regard to case.
    [[nodiscard]] std::vector<std::string> values(std::string_view name) const;
};

struct Response {
    int status = 200;
    std::string content_type = "application/json";
    std::string body;
    std::vector<std::pair<std::string, std::string>> headers = {};
};

/// `{"error": trouble}` with that status.
[[nodiscard]] Response refusal(int status, std::string_view trouble);

/// Keys as a refusal lists them: "at, note", or "none".
[[nodiscard]] std::string joined(const std::vector<std::string>& keys);

}  // namespace a351::daemon
