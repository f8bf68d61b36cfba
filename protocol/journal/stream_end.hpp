#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "protocol/journal/journal.hpp"

namespace a351::record {

/// Where a stream stood when it was last heard of.
struct StreamEnd {
    JournalHeader header;
    std::uint16_t count = 0;  ///< COUNT of the last frame.
    RawTime arrival;
};

/// Of the newest session in the journal; std::nullopt when no frame of it is there, or frames have
/// no counter.
/// @param segments  as journal_segments() gives them, or the last of these.
/// @throws std::system_error  a segment cannot be read.
[[nodiscard]] std::optional<StreamEnd> stream_end(
    const std::vector<std::filesystem::path>& segments);

}  // namespace a351::record
