#pragma once
/// @file
/// The payload of a HEAD chunk: the header of a journal segment as one line of JSON.
/// Layout: protocol/journal/journal-format.md, "HEAD".

#include <optional>
#include <string>
#include <string_view>

#include "protocol/journal/journal.hpp"

namespace a351::journal {

/// Returns the payload of a header: one line of JSON.  Bytes that are not UTF-8 become U+FFFD.
///
/// The order of the keys is fixed.  Members with their default are left out if the format permits
/// it: device_assumed, port, declared_rate_hz, oven_interval_s, outer_oven_interval_s,
/// record_age_s, leap and repeats.  A declared rate must be finite, because parse_header() refuses
/// the `null` that JSON has instead.
[[nodiscard]] std::string header_to_json(const Header& header);

/// Reads the payload of a header.  Unknown fields are ignored.
///
/// These are compared with their limits: session, station codes, clock, leap, both oven intervals,
/// record_age_s.  Profile, filter, rates and burst_ctrl are not: find them in the profile before
/// use.  A number that does not fit the type of its member is converted, not refused.
///
/// @param text  one JSON object in UTF-8; white space around it is permitted.
/// @return std::nullopt unless the text is an object, every required field is present and
///         convertible to its member, and those above are within their limits.
[[nodiscard]] std::optional<Header> parse_header(std::string_view text);

}  // namespace a351::journal
