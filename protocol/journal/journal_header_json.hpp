#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "protocol/journal/journal.hpp"

namespace a351::record {

/// Returns the header as one line of JSON.  Bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string header_to_json(const JournalHeader& header);

/// Reads a header.  Unknown fields are ignored.
/// @return std::nullopt unless every required field is present, of its type and in range.
[[nodiscard]] std::optional<JournalHeader> parse_header(std::string_view text);

}  // namespace a351::record
