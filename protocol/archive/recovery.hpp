#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "protocol/archive/archive_writer.hpp"
#include "protocol/archive/sds.hpp"
#include "protocol/files/file_layer.hpp"
#include "protocol/journal/journal_reader.hpp"

namespace a351::record {

/// Damage that was found and repaired at start.
struct RecoveryReport {
    std::optional<JournalDamage> journal;
    std::vector<TornTail> archive;
    std::uint64_t records_added = 0;        ///< Records that the archive lacked.
    std::uint64_t records_confirmed = 0;    ///< Records that the archive already held.
    std::uint64_t records_conflicting = 0;  ///< Skipped: the archive holds others at their time.
    std::uint64_t chunks_lost = 0;          ///< Journal chunks that could not be interpreted.
};

/// Part of the journal that goes into one archive.
struct Replay {
    std::vector<std::filesystem::path> segments;
    StationCodes codes;             ///< Codes of all these segments.
    std::optional<MarkChunk> mark;  ///< Newest MARK, if its session is among these segments.
};

/// Part of the journal that is replayed into the archive at start, oldest first: everything from
/// the first segment of the session that the newest MARK names.  Older sessions were complete in
/// the archive when that MARK was written.  Without a MARK it is the whole journal.
struct RecoveryPlan {
    std::vector<Replay> replays;
    std::optional<JournalDamage> cut;  ///< Torn tail of the newest segment.
};

/// Cuts a torn tail of the journal, syncs its newest segment, and determines the segments to be
/// replayed.  Data journaled later do not belong to them.
/// @throws std::system_error  a file cannot be read or written.
[[nodiscard]] RecoveryPlan begin_recovery(FileLayer& files, const std::filesystem::path& journal);

/// Cuts torn tails of the archive, then passes the replayed chunks to `take`, which must archive
/// them through `writer`, like all later chunks.  Afterwards the archive holds every sample of the
/// records made of these chunks once.
///
/// Idempotent: a second run, or one that was killed and started again, ends with the same bytes.
/// They are those of an uninterrupted run, except where an earlier shutdown ended records early.
///
/// @param take    returns false to stop.  If it throws InputError, the chunk is skipped and
///                counted.
/// @param report  counts are added to it.
/// @return true if the replay reached the end.
/// @throws std::system_error  a file cannot be read or written; begin again with another writer.
[[nodiscard]] bool replay_journal(FileLayer& files, const std::filesystem::path& archive,
                                  const Replay& replay, ArchiveWriter& writer,
                                  const std::function<bool(const JournalChunk&)>& take,
                                  RecoveryReport& report);

}  // namespace a351::record
