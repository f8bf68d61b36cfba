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

/// Writes the archive of a data root again, with times computed afterwards: each second from the
/// arrivals 450 s before and after it, and from the readings at which the host's clock was
/// synchronised.  Samples, gaps and channels are those of the running daemon; records may end at
/// other samples.  Events keep their samples and get the new times; metadata are copied.  The
/// journal is not copied.
///
/// The result is complete or absent: it is written beside `out` and renamed at the end.
///
/// @throws InputError         no journal in `root`, or `out` exists.
/// @throws std::system_error  a file cannot be read or written.
RetimeReport retime(FileLayer& files, const std::filesystem::path& root,
                    const std::filesystem::path& out);

}  // namespace a351::record
