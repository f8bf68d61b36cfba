#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/text/message.hpp"

namespace a351::daemon::page {

/// A complete HTTP request, independent of the network library.
struct Request {
    std::string method;
    std::string target;                                        ///< Path with query.
    std::vector<std::pair<std::string, std::string>> headers;  ///< Headers as received, in order.
    std::string body;
    std::string address = {};  ///< Address and port of this host to which the client connected.
    bool is_local = false;     ///< The client is on this host.

    /// Returns all values of the header `name`; upper and lower case are equal.
    [[nodiscard]] std::vector<std::string> values(std::string_view name) const;
};

struct Response {
    int status = 200;
    std::string content_type = "application/json";
    std::string body;
    std::vector<std::pair<std::string, std::string>> headers = {};
};

/// A file that is made while it is sent.
///
/// The server calls `open` once and then `next`, in a thread that may wait for the disk and gives way
/// to all others.  An exception ends the connection, so that the client sees a file that is too
/// short.
struct Download {
    std::string name;                     ///< Name that is proposed for the file.
    std::function<std::uint64_t()> open;  ///< Returns the size, bytes.
    std::function<std::string()> next;    ///< Returns the next bytes; empty at the end.
};

/// Returns `{"error": trouble, "error_parts": its parts}` with this status.
[[nodiscard]] Response refusal(int status, const text::Message& trouble);

/// @throws InputError  `key` is not in the list; names the part of the request and the list.
void require_allowed(std::string_view part, const std::string& key,
                     const std::vector<std::string>& allowed);

/// Reads the value of a key in this part of the request.
/// @throws InputError  it is not RFC 3339; names the key.
[[nodiscard]] UtcTime parse_instant(std::string_view part, const std::string& key,
                                    const std::string& text);

/// Reads the part of a target after the question mark: key=value joined by &, percent-encoded.
/// @param allowed  keys that may be given.
/// @throws InputError  a key that is not allowed or given twice, or a broken encoding; names it.
[[nodiscard]] std::map<std::string, std::string> parse_query(
    std::string_view query, const std::vector<std::string>& allowed);

}  // namespace a351::daemon::page
