#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "protocol/journal/journal.hpp"

namespace a351::record {

/// One line of JSON.  Bytes that are no UTF-8 become U+FFFD.
[[nodiscard]] std::string header_to_json(const JournalHeader& header);

/// @return std::nullopt unless every field of a header is there with its type; others are ignored.
[[nodiscard]] std::optional<JournalHeader> parse_header(std::string_view text);

}  // namespace a351::record
