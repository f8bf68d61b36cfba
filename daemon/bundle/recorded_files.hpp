#pragma once
/// @file
/// The recorded files of some days, as far as their bytes are whole and safe on the disk, while the
/// daemon appends to them.
///
/// - Archive: whole records.  Event log: whole lines.  Newest journal segment: whole chunks.
/// - Everything in the archive was journaled before.  So the sizes of the archive are taken first,
///   then those of the events, then those of the journal, and the journal is synced first.
/// - A segment of the journal can be compressed or removed while others are read, so an
///   uncompressed one stays open.  So does a file that changes now.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "daemon/bundle/open_file.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::daemon::bundle {

/// A part of a recorded file that does not change any more.
struct RecordedFile {
    std::filesystem::path path;
    std::string name;        ///< Relative to the data root, with '/'.
    std::uint64_t size = 0;  ///< Bytes from its begin on.
    std::chrono::sys_seconds time{};
    std::shared_ptr<const OpenFile> open{};  ///< Empty: it is opened for each read.

    /// Returns `count` of its bytes.  @throws std::system_error
    [[nodiscard]] std::string read(std::uint64_t offset, std::uint64_t count) const;
};

/// Returns the files of a day and its past: the day files of the archive from the UTC day of
/// `from`, the event log from its month, the journal from its segment, and the station metadata.
///
/// Segments are chosen by the time in their names.  If the host clock was wrong, there may be more
/// of them.  Links are left out.
/// @throws std::system_error  a folder or a file cannot be read or synced.
[[nodiscard]] std::vector<RecordedFile> recorded_files(const std::filesystem::path& root,
                                                       UtcTime from);

}  // namespace a351::daemon::bundle
