#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "protocol/archive/archiver.hpp"
#include "protocol/files/file_layer.hpp"
#include "protocol/journal/journal_reader.hpp"

namespace a351::record {

struct RetimeReport {
    std::uint64_t segments = 0;
    std::uint64_t records = 0;
    std::vector<JournalDamage> damage;  ///< Segments that end early.
    ArchiverCounters counters;
};

/// Writes the archive of a data root anew, with times from what was known at the end: the clock of
/// a second from the arrivals 450 s before and after it, and the host's clock between the readings
/// at which it was synchronised.  Samples, gaps and channels are those of the running daemon;
/// records may end elsewhere.  Events keep their samples and get their new times; metadata are
/// copied.  The journal stays where it is.
///
/// All or nothing: written beside `out` and renamed at the end.
///
/// @throws InputError         no journal in `root`, or `out` exists.
/// @throws std::system_error  a file cannot be read or written.
RetimeReport retime(FileLayer& files, const std::filesystem::path& root,
                    const std::filesystem::path& out);

}  // namespace a351::record
