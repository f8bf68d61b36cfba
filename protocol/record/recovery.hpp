#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "protocol/record/archiver.hpp"
#include "protocol/record/file_layer.hpp"
#include "protocol/record/journal_reader.hpp"
#include "protocol/record/sds.hpp"

namespace a351::record {

/// What was found and mended at start.
struct RecoveryReport {
    std::optional<JournalDamage> journal;
    std::vector<TornTail> archive;
    std::uint64_t records_added = 0;        ///< The archive was behind the journal by these.
    std::uint64_t records_confirmed = 0;    ///< Already there, the same samples at the same time.
    std::uint64_t records_conflicting = 0;  ///< Others are there at that time; left as they are.
    ArchiverCounters replayed;
};

/// Makes a data root whole after a crash: cuts torn tails, then replays the journal so that the
/// archive holds every sample the journal holds, each once, and syncs it.
///
/// Replayed is all from the first segment of the session that the newest MARK names: older sessions
/// were complete in the archive when it was written.  Without a MARK, the whole journal.
///
/// Idempotent: a second run, or one that was killed half-way and started again, ends with the same
/// bytes.  They are those of an uninterrupted run that closed its records at the end of the
/// journal, where records were not ended earlier by a shutdown or a recovery before this one.
///
/// @throws std::system_error  a file cannot be read or written.
/// @throws InputError         a journal header names an unknown profile or impossible settings.
RecoveryReport recover(FileLayer& files, const std::filesystem::path& data_root);

}  // namespace a351::record
