#pragma once
/// @file
/// The record of each stream that a ring acknowledged last, in a file.  It is used only if the ring
/// has no packet of the stream any more.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "daemon/stream/archive_streams.hpp"

namespace a351::daemon::stream {

/// Record that the ring acknowledged.
struct Position {
    std::uint64_t packet = 0;  ///< ID that the ring gave it.
    Mark mark;

    bool operator==(const Position&) const = default;
};

/// Positions by stream.
using Positions = std::map<std::string, Position>;

/// Returns a file of positions: a line "STREAM PACKET SEQUENCE START END" for each stream, the
/// times in RFC 3339 with nine decimals.
[[nodiscard]] std::string to_text(const Positions& positions);

/// Reads what to_text() wrote.
/// @return std::nullopt if a line is damaged.
[[nodiscard]] std::optional<Positions> parse_positions(const std::string& text);

}  // namespace a351::daemon::stream
