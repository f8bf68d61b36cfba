#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "protocol/journal/journal.hpp"

namespace a351::record {

/// Tells which chunks were met before.  A segment whose header says `repeats` begins with the chunks
/// that followed the last good sync of an earlier one, for the disk may have lost them there.  Some
/// or all may be there after all, also in further attempts between the two.
///
/// Segments are read in order, each to its end or its first damage.
class Repetitions {
public:
    /// @param segment  number of the segment.  @param sequence  of the chunk within it.
    /// @return true when the chunk was met before, and is to be passed over.
    [[nodiscard]] bool is_repeated(std::uint64_t segment, std::uint32_t sequence,
                                   const JournalChunk& chunk);

private:
    std::optional<RepeatedChunks> from_;  ///< Where the chunks stood first.
    std::uint32_t met_ = 0;               ///< Of these.
    std::uint32_t to_skip_ = 0;           ///< Of the segment at hand.
    std::uint64_t last_segment_ = 0;
    std::uint32_t last_sequence_ = 0;
};

}  // namespace a351::record
