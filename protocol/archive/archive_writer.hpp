#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "protocol/archive/archiver.hpp"
#include "protocol/archive/sds.hpp"

namespace a351::record {

/// Writes the archiver's records into the SDS archive.  Sequence numbers continue those in the
/// archive: per channel 1 ... 999999 and again from 1.
class ArchiveWriter : public ArchiveSink {
public:
    ArchiveWriter(FileLayer& files, std::filesystem::path archive, StationCodes codes);

    /// Begins a replay of the journal: records that the archive already holds are not written
    /// again.  Each day file concerned is read and synced first, because the previous writer may
    /// not have synced it.
    void begin_replay() { is_replaying_ = true; }
    /// Ends the replay: all further records are new, whatever their times.
    void end_replay();

    /// Begins another session: sync() no longer reports samples of older ones.
    void begin_session();

    /// Closes all files after a fault and examines the archive again.
    void reopen();

    /// Writes a record.  In a replay, a record with the same start and samples as one in the
    /// archive is skipped.  Each record of the archive counts once, because times repeat after a
    /// clock was set back.  A record that overlaps other records, not yet matched by the replay, is
    /// a conflict: it is skipped too, the archive is right, and sync() does not report it.
    /// @throws std::system_error  the archive cannot be written.
    void record(const std::string& channel, const PackedRecord& record,
                std::int64_t last_index) override;
    [[nodiscard]] std::optional<std::size_t> samples_in_archive(const std::string& channel,
                                                                UtcTime start) const override;

    /// Syncs the archive.
    /// @return the last sample per channel that now survives a power cut.
    /// @throws std::system_error  the archive could not be synced.
    [[nodiscard]] std::vector<ChannelMark> sync();

    [[nodiscard]] std::uint64_t records_written() const noexcept { return records_written_; }
    [[nodiscard]] std::uint64_t records_skipped() const noexcept { return records_skipped_; }
    /// Returns the number of records skipped because the archive holds other samples at their time.
    [[nodiscard]] std::uint64_t replay_conflicts() const noexcept { return replay_conflicts_; }

private:
    struct ArchivedRecord {
        std::size_t sample_count = 0;
        std::size_t samples_hash = 0;
        UtcTime end;  ///< Half a sample after the last sample.
    };
    struct Newest {
        PackedRecord record;
        std::int64_t last_index = 0;
    };
    struct Channel {
        std::optional<int> sequence;  ///< Sequence number of the newest record.
        std::optional<Newest> newest;
        std::set<std::filesystem::path> days_read;  ///< Day files read in this replay.
        std::multimap<UtcTime, ArchivedRecord>
            held;  ///< Records not yet matched in the replay, by start.
    };
    enum class Found { nothing, same, other };

    Channel& replayed(const std::string& name, UtcTime start) const;
    void load(Channel& channel, const std::filesystem::path& day_file) const;
    [[nodiscard]] Found find(const std::string& name, const PackedRecord& record);
    [[nodiscard]] int newest_sequence(const std::string& channel) const;
    static ArchivedRecord describe(const DecodedRecord& record);

    FileLayer& files_;
    std::filesystem::path archive_;
    StationCodes codes_;
    std::unique_ptr<SdsWriter> sds_;
    bool is_replaying_ = false;
    mutable std::map<std::string, Channel> channels_;  ///< Days are read when needed.
    std::uint64_t records_written_ = 0;
    std::uint64_t records_skipped_ = 0;
    std::uint64_t replay_conflicts_ = 0;
};

}  // namespace a351::record
