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

/// Puts the archiver's records into the SDS archive, numbering them on from what is there: per
/// channel 1 ... 999999 and again from 1.
class ArchiveWriter : public ArchiveSink {
public:
    ArchiveWriter(FileLayer& files, std::filesystem::path archive, StationCodes codes);

    /// From now on nothing is written that the archive already holds: the journal is being
    /// replayed.  The day files that it comes to are read and synced first, for the writer before
    /// may not have done so.
    void begin_replay();
    /// What comes is new, whatever its times.
    void end_replay();

    /// What comes is of another session: sync() speaks of nothing older.
    void begin_session();

    /// After a fault: closes all files, and looks anew at what is there.
    void reopen();

    /// In a replay, a record that the archive holds with the same start and samples is passed over,
    /// once: after a clock that was set back times come twice.  So is one that overlaps others that
    /// the replay has not met: that is a conflict, and the archive is right; sync() does not speak of
    /// it.
    /// @throws std::system_error  the archive cannot be written.
    void record(const std::string& channel, const PackedRecord& record,
                std::int64_t last_index) override;
    [[nodiscard]] std::optional<std::size_t> samples_held(const std::string& channel,
                                                          UtcTime start) const override;

    /// Syncs the archive; the last sample per channel that now survives a power cut.
    /// @throws std::system_error  it does not.
    [[nodiscard]] std::vector<ChannelMark> sync();

    [[nodiscard]] std::uint64_t records_written() const noexcept { return records_written_; }
    [[nodiscard]] std::uint64_t records_passed_over() const noexcept {
        return records_passed_over_;
    }
    /// Records passed over because the archive holds other samples at their time.
    [[nodiscard]] std::uint64_t replay_conflicts() const noexcept { return replay_conflicts_; }

private:
    struct Held {
        std::size_t sample_count = 0;
        std::size_t samples_hash = 0;
        UtcTime end;  // half a sample after the last one
    };
    struct Newest {
        PackedRecord record;
        std::int64_t last_index = 0;
    };
    struct Channel {
        std::optional<int> sequence;  // of the newest record
        std::optional<Newest> newest;
        std::set<std::filesystem::path> days_read;  // in the replay
        std::multimap<UtcTime, Held> held;          // by start, until the replay meets or passes it
    };
    enum class Found { nothing, same, other };

    Channel& replayed(const std::string& name, UtcTime start) const;
    void load(Channel& channel, const std::filesystem::path& day_file) const;
    [[nodiscard]] Found find(const std::string& name, const PackedRecord& record);
    [[nodiscard]] int newest_sequence(const std::string& channel) const;
    static Held describe(const DecodedRecord& record);

    FileLayer& files_;
    std::filesystem::path archive_;
    StationCodes codes_;
    std::unique_ptr<SdsWriter> sds_;
    bool is_replaying_ = false;
    mutable std::map<std::string, Channel> channels_;  ///< Days are read when they are asked for.
    std::uint64_t records_written_ = 0;
    std::uint64_t records_passed_over_ = 0;
    std::uint64_t replay_conflicts_ = 0;
};

}  // namespace a351::record
