#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace a351::daemon {

/// Reads the part of a target after the question mark: key=value joined by &, percent-encoded.
/// @param allowed  keys that may be given.
/// @throws InputError  a key that is not allowed or given twice, or a broken encoding; names it.
[[nodiscard]] std::map<std::string, std::string> parse_query(
    std::string_view query, const std::vector<std::string>& allowed);

}  // namespace a351::daemon
