#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sim/replay/recording.hpp"

namespace a351::sim {

struct RecordingFiles {
    /// Journal segments or miniSEED files, distinguished by their first bytes.  A directory means
    /// the segments in it, or, if it has none, the day files below it.  In a directory, segments
    /// without a whole header are skipped and reported by Recording::damage().
    std::vector<std::filesystem::path> files;
    std::array<std::string, 3> axes{"1", "2", "Z"};  ///< Channels of x, y, z; for archives.
    RecordedUnit archive_unit = {};                  ///< Unit to emulate for an archive.
};

/// Opens the files.  Segments of one directory are replayed by number, directories in the order
/// given.
/// @throws InputError  a file is missing, empty or of neither kind; journal and miniSEED are mixed;
///         JournalRecording or ArchiveSource refuses the files.
[[nodiscard]] std::unique_ptr<Recording> open_recording(const RecordingFiles& input);

}  // namespace a351::sim
