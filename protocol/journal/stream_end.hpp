#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "protocol/journal/journal.hpp"

namespace a351::record {

/// Last known state of a stream.
struct StreamEnd {
    JournalHeader header;
    std::uint16_t count = 0;  ///< COUNT of the last frame.
    RawTime arrival;          ///< Time of the last read() of the chunk that ends that frame.
};

/// Returns the end of the newest session in the journal; std::nullopt if the journal has no frame
/// of it, or the frames have no counter.
/// @param segments  result of journal_segments(), or the last of these.
/// @throws std::system_error  a segment cannot be read.
[[nodiscard]] std::optional<StreamEnd> stream_end(
    const std::vector<std::filesystem::path>& segments);

}  // namespace a351::record
