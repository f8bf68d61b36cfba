#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sim/replay/recording.hpp"

namespace a351::sim {

struct RecordingFiles {
    /// Journal segments or miniSEED files, told apart by their first bytes; of a directory, the
    /// segments in it, or else the day files below it.  Of a directory, segments without a whole
    /// header are passed over and told of by Recording::damage().
    std::vector<std::filesystem::path> files;
    std::array<std::string, 3> axes{"1", "2", "Z"};  ///< For archives: channels of x, y, z.
    RecordedUnit archive_unit = {};                  ///< What an archive does not tell.
};

/// Segments of one directory are replayed by their number, directories in the order given.
/// @throws InputError  a file is missing, empty, neither of both kinds, or journal and miniSEED are
///         mixed; and what JournalRecording and ArchiveSource refuse.
[[nodiscard]] std::unique_ptr<Recording> open_recording(const RecordingFiles& input);

}  // namespace a351::sim
