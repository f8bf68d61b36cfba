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

/// What was found and mended at start.
struct RecoveryReport {
    std::optional<JournalDamage> journal;
    std::vector<TornTail> archive;
    std::uint64_t records_added = 0;        ///< The archive was behind the journal by these.
    std::uint64_t records_confirmed = 0;    ///< Already there, the same samples at the same time.
    std::uint64_t records_conflicting = 0;  ///< Others are there at that time; left as they are.
    std::uint64_t chunks_lost = 0;          ///< Of the journal, that could not be understood.
};

/// A part of the journal that goes into one archive.
struct Replay {
    std::vector<std::filesystem::path> segments;
    StationCodes codes;             ///< Of all of them.
    std::optional<MarkChunk> mark;  ///< The newest, when its session is among these.
};

/// What of the journal is brought into the archive at start, the oldest first: all from the first
/// segment of the session that the newest MARK names, for older sessions were complete in the
/// archive when it was written.  Without a MARK, the whole journal.
struct RecoveryPlan {
    std::vector<Replay> replays;
    std::optional<JournalDamage> cut;  ///< Torn tail of the newest segment.
};

/// Cuts a torn tail of the journal, syncs its newest segment, and fixes what is to be replayed:
/// what is journaled from now on does not belong to it.
/// @throws std::system_error  a file cannot be read or written.
[[nodiscard]] RecoveryPlan begin_recovery(FileLayer& files, const std::filesystem::path& journal);

/// Cuts torn tails of the archive, then gives the replayed chunks to `take`, which archives them
/// through `writer`, as it must whatever follows.  In the end the archive holds every sample that
/// these make a record of, once.
///
/// Idempotent: a second run, or one that was killed half-way and started again, ends with the same
/// bytes.  They are those of an uninterrupted run, where records were not ended earlier by a
/// shutdown before this one.
///
/// @param take  false: no more of it.  InputError from it costs the chunk, which is counted.
/// @param report  is added to.
/// @return  whether it came to the end.
/// @throws std::system_error  a file cannot be read or written; to be begun anew with another
///         writer.
[[nodiscard]] bool replay_journal(FileLayer& files, const std::filesystem::path& archive,
                                  const Replay& replay, ArchiveWriter& writer,
                                  const std::function<bool(const JournalChunk&)>& take,
                                  RecoveryReport& report);

}  // namespace a351::record
