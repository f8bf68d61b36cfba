#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "protocol/journal/journal.hpp"

namespace a351::record {

/// Recognises chunks that were read before.  A segment whose header has `repeats` begins with the
/// chunks that followed the last good sync of an earlier segment, because the disk may have lost
/// them there.  Some or all of them may still exist there, or in further attempts between the two.
///
/// Segments must be read in order, each to its end or its first damage.
class Repetitions {
public:
    /// Returns true if the chunk was read before and must be skipped.
    /// @param segment   number of the segment.
    /// @param sequence  sequence number of the chunk within it.
    [[nodiscard]] bool is_repeated(std::uint64_t segment, std::uint32_t sequence,
                                   const JournalChunk& chunk);

private:
    std::optional<RepeatedChunks> from_;  ///< First place of the repeated chunks.
    std::uint32_t chunks_read_ = 0;       ///< Number of these that were read.
    std::uint32_t to_skip_ = 0;           ///< Number of chunks to skip in this segment.
    std::uint64_t last_segment_ = 0;
    std::uint32_t last_sequence_ = 0;
};

}  // namespace a351::record
