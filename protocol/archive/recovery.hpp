#pragma once
/// @file
/// The archive after a crash or a power cut: damaged ends are cut, and records that are missing are
/// made again from the journal.
///
/// Call it at every start:
///
///     const RecoveryPlan plan = begin_recovery(files, journal);  // before anything is journaled
///     for (const Replay& replay : plan.replays) {
///         Writer writer(files, archive, replay.codes);
///         Archiver archiver(writer);
///         const auto take = [&](const journal::Chunk& chunk) { archiver.take(chunk); return true; };
///         if (!replay_journal(files, archive, replay, writer, take, report)) return;
///         archiver.close_records();        // unless the last stream continues
///         writer.settle();
///         marks = writer.sync();
///     }
///
/// If the sensor's stream still runs, the last archiver and its writer continue with it, and its
/// records must not be closed.  The writer may stay in the replay until the next session begins.

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "protocol/archive/archive_writer.hpp"
#include "protocol/archive/sds.hpp"
#include "protocol/files/file_layer.hpp"
#include "protocol/journal/journal_reader.hpp"

namespace a351::archive {

/// Damage that was found and repaired at start.
struct RecoveryReport {
    std::optional<journal::Damage> journal;  ///< RecoveryPlan::cut; the caller sets it.
    std::vector<journal::Damage>
        damage;                       ///< Places of the replayed segments whose chunks are lost.
    std::vector<TornTail> archive;    ///< Parts of day files that were cut.
    std::uint64_t records_added = 0;  ///< Records that the archive lacked.
    std::uint64_t records_confirmed = 0;    ///< Records that the archive already held.
    std::uint64_t records_conflicting = 0;  ///< Skipped: the archive holds others at their time.
    std::uint64_t chunks_lost = 0;          ///< Journal chunks that could not be interpreted.
};

/// Part of the journal that goes into one archive: successive segments with the same station codes.
struct Replay {
    /// Files in the order in which they were written.
    std::vector<std::filesystem::path> segments;
    journal::StationCodes codes;  ///< Codes of all these segments.
    std::optional<journal::MarkChunk>
        mark;  ///< Newest MARK, if its session is among these segments.
};

/// Part of the journal that is replayed into the archive at start, oldest first: everything from
/// the first segment of the session that the newest MARK names.  Older sessions were complete in
/// the archive when that MARK was written.  Without a MARK it is the whole journal.
struct RecoveryPlan {
    std::vector<Replay> replays;         ///< Empty without a journal.
    std::optional<journal::Damage> cut;  ///< Torn tail of the newest segment.
};

/// Cuts a torn tail of the journal, syncs its newest segment, and determines the segments to be
/// replayed.  Data journaled later do not belong to them.
///
/// Cost: segments are read from the newest back to the one with the newest MARK.
/// @param journal  directory of the segments; it may be missing.
/// @throws std::system_error  a file cannot be read or written.
[[nodiscard]] RecoveryPlan begin_recovery(files::FileLayer& files,
                                          const std::filesystem::path& journal);

/// Cuts torn tails of the archive, then passes the replayed chunks to `take`, which must archive
/// them through `writer`, like all later chunks.  Afterwards the archive holds every sample of the
/// records made of these chunks once.
///
/// Idempotent: a second run, or one that was killed and started again, ends with the same bytes.
/// They are those of an uninterrupted run, except where an earlier shutdown ended records early.
///
/// The bytes cut from the archive are kept in side_directory().  Damage within a segment costs the
/// chunks in it; the replay continues after it.
///
/// @param writer  new, for the codes of `replay`.  Afterwards it is still in its replay, and not
///                synced.
/// @param take    returns false to stop.  If it throws InputError, the chunk is skipped and
///                counted.
/// @param report  counts are added to it; those of records only if the replay reached the end.
/// @return true if the replay reached the end, false if `take` stopped it.
/// @throws std::system_error  a file cannot be read or written; begin again with another writer.
[[nodiscard]] bool replay_journal(files::FileLayer& files, const std::filesystem::path& archive,
                                  const Replay& replay, Writer& writer,
                                  const std::function<bool(const journal::Chunk&)>& take,
                                  RecoveryReport& report);

}  // namespace a351::archive
