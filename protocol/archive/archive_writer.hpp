#pragma once
/// @file
/// The last step of archiving: numbers records, writes them to day files, and reports which samples
/// survive a power cut.
///
///     Writer writer(files, archive, codes);
///     Archiver archiver(writer);
///     writer.begin_replay();                 // only if the archive may already have the records
///     for (...) archiver.take(old_chunk);
///     writer.end_replay();
///     for (...) archiver.take(new_chunk);
///     const auto marks = writer.sync();      // about every 30 s
///
/// replay_journal() replays the journal after a crash.  SdsWriter writes records without numbering
/// and comparing them.

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "protocol/archive/archiver.hpp"
#include "protocol/archive/sds.hpp"

namespace a351::archive {

/// Returns true if a record was written before another one of its channel, according to their
/// sequence numbers: it is less than half a million records before it.
[[nodiscard]] bool precedes(int sequence, int other) noexcept;

/// Writes the archiver's records into the SDS archive.  Sequence numbers continue those in the
/// archive: per channel 1 ... 999999 and again from 1.
///
/// Only one writer at a time may write to the archive of a station.  Not thread-safe.  The
/// destructor does not sync.
class Writer : public Sink {
public:
    /// Reads and writes nothing yet; directories are made with the first record.
    /// @param files    must outlive this.
    /// @param archive  root of the archive; it may be missing.
    /// @param codes    valid codes, see are_valid(); they become parts of the path.
    Writer(files::FileLayer& files, std::filesystem::path archive, journal::StationCodes codes);

    /// Begins a replay of the journal: records that the archive already holds are not written
    /// again.  Each day file concerned is read and synced first, because the previous writer may
    /// not have synced it.
    void begin_replay() { is_replaying_ = true; }
    /// Ends the replay: all further records are new, whatever their times.  Records of the archive
    /// that the replay did not make remain there.
    void end_replay();

    /// Begins another session: sync() no longer reports samples of older ones.  Call settle() and
    /// sync() before, and this function before the first record of the session.
    void begin_session();

    /// Closes all files after a fault and examines the archive again.  Call it after record() or
    /// sync() threw.  It does not sync.  Data that a failed sync lost can only come from the
    /// journal.
    void reopen();

    /// Writes a record.  In a replay, a record with the same start and samples as one in the
    /// archive is skipped.  Each record of the archive counts once, because times repeat after a
    /// clock was set back.
    ///
    /// A record without such a match that overlaps unmatched records of the archive is held back
    /// until the next match, or settle().  The replay makes records in the order in which they are
    /// in the archive, so the places of the matches decide:
    /// - One of the overlapped records is between the matches before and after: a conflict.  The
    ///   archive is right, the record is skipped, and sync() does not report it.
    /// - None is: they have its time only because a clock was set back.  The record is written.
    ///
    /// The order is broken where an earlier replay filled a hole: that record is at the end of its
    /// file.
    /// @param record      result of pack_record(); its sequence number is replaced.
    /// @param last_index  index of the last sample of the record, reported by sync().
    /// @throws std::system_error  the archive cannot be written.  The record can be given again.
    void record(const std::string& channel, const PackedRecord& record,
                std::int64_t last_index) override;
    /// Decides on the records held back, when no more of the replay is to come for now.  Call it
    /// before sync(), which leaves them where they are; end_replay() does so itself.
    /// @throws std::system_error  the archive cannot be written; call it again.
    void settle();
    /// Returns the number of samples of an archived record that the replay has not matched yet.
    /// std::nullopt if there is none with this start, or outside a replay.
    [[nodiscard]] std::optional<std::size_t> samples_in_archive(const std::string& channel,
                                                                UtcTime start) const override;

    /// Numbers of samples of archived records, by channel and start.
    using Held = std::map<std::string, std::map<UtcTime, std::size_t>>;
    /// Returns the archived records that the replay has not matched yet, of the days it read and of
    /// each channel's newest day.  It is for a sink that must not wait for the disk.
    /// @throws std::system_error  a day file cannot be read.
    [[nodiscard]] Held held() const;

    /// Syncs the archive.
    /// @return the last sample per channel that now survives a power cut, in the order of the
    ///         codes.  Channels without a record since begin_session() are absent.
    /// @throws std::system_error  the archive could not be synced.
    [[nodiscard]] std::vector<journal::ChannelMark> sync();

    /// Returns the number of records appended since construction.
    [[nodiscard]] std::uint64_t records_written() const noexcept { return records_written_; }
    /// Returns the number of replayed records that the archive already held.
    [[nodiscard]] std::uint64_t records_skipped() const noexcept { return records_skipped_; }
    /// Returns the number of records skipped because the archive holds other samples at their time.
    [[nodiscard]] std::uint64_t replay_conflicts() const noexcept { return replay_conflicts_; }

private:
    struct ArchivedRecord {
        std::size_t sample_count = 0;
        std::size_t samples_hash = 0;
        UtcTime end;                ///< Half a sample after the last sample.
        std::chrono::sys_days day;  ///< Day of its file.
        std::uint64_t offset = 0;   ///< Place in the file.
        int sequence = 0;           ///< Sequence number.
    };
    struct Newest {
        PackedRecord record;
        std::int64_t last_index = 0;
        int session = 0;  ///< Number of the session, as session_count_.
    };
    struct Channel {
        std::optional<int> sequence;  ///< Sequence number of the newest record.
        std::optional<Newest> newest;
        std::set<std::filesystem::path> days_read;  ///< Day files read in this replay.
        std::multimap<UtcTime, ArchivedRecord>
            held;  ///< Records not yet matched in the replay, by start.
        /// Offset of the last record matched, by day.  Records before it were written earlier.
        std::map<std::chrono::sys_days, std::uint64_t> matched;
        std::optional<int> newest_match;  ///< Its sequence number, for days without a match.
        std::deque<Newest> held_back;  ///< In the order of the replay.
    };
    enum class Found { nothing, same, other };

    Channel& replayed(const std::string& name, UtcTime start) const;
    void load(Channel& channel, const std::filesystem::path& day_file) const;
    [[nodiscard]] Found find(const std::string& name, const PackedRecord& record);
    void settle(const std::string& name, Channel& channel, const ArchivedRecord* next);
    void write(const std::string& name, Channel& channel, const Newest& made);
    [[nodiscard]] int newest_sequence(const std::string& channel) const;
    static ArchivedRecord describe(const DecodedRecord& record);

    files::FileLayer& files_;
    std::filesystem::path archive_;
    journal::StationCodes codes_;
    std::unique_ptr<SdsWriter> sds_;
    bool is_replaying_ = false;
    mutable std::map<std::string, Channel> channels_;  ///< Days are read when needed.
    int session_count_ = 0;
    std::uint64_t records_written_ = 0;
    std::uint64_t records_skipped_ = 0;
    std::uint64_t replay_conflicts_ = 0;
};

}  // namespace a351::archive
