#pragma once
/// @file
/// The last frame in the journal.  A program that finds a sensor still sampling compares its
/// counter with this one.  If it fits, the session continues, and no new one is started.
///
///     const auto end = stream_end(segment_files(directory));
///     if (end) listen(end->header.baud);  // Does COUNT continue from end->count, end->arrival?
///
/// Repair the newest segment first (repair_newest_segment()).

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "protocol/journal/journal.hpp"

namespace a351::journal {

/// Last known state of a stream.
struct StreamEnd {
    /// Header of the segment that holds the frame: settings of the device, and the boot that
    /// defines the zero of `arrival`.
    Header header;
    std::uint16_t count = 0;  ///< COUNT of the last frame.
    RawTime arrival;          ///< Time of the last read() of the chunk that ends that frame.
};

/// Returns the end of the newest session in the journal; std::nullopt if the journal has no frame
/// of it, or the frames have no counter.
///
/// The result is std::nullopt too if the header names an unknown profile, a rate that the profile
/// lacks, or an invalid layout.  Segments without a good header are skipped.
///
/// Segments are read from the newest to older ones, until one of the session has a frame.  Each is
/// decoded by itself: a frame cut by the border of two segments is not found, and a single frame of
/// a segment is not confirmed (BurstDecoder).  Normally only the newest segment is read, in a time
/// proportional to its size.
///
/// @param segments  result of segment_files(), or the last of these.
/// @throws std::system_error  a segment cannot be read.
[[nodiscard]] std::optional<StreamEnd> stream_end(
    const std::vector<std::filesystem::path>& segments);

}  // namespace a351::journal
