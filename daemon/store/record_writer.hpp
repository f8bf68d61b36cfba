#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "daemon/store/archive_health.hpp"
#include "daemon/store/journal_thread.hpp"
#include "daemon/store/options.hpp"
#include "daemon/store/station_metadata.hpp"
#include "daemon/store/waiting_records.hpp"
#include "protocol/archive/archive_writer.hpp"

namespace a351::daemon::store {

/// Writes the waiting records to the day files, after the metadata of their session.  Syncs them
/// every 30 s, and marks in the journal what then survives a power cut.
///
/// For the thread that writes: it waits for the disk, and has no lock.  The recovery calls begin()
/// before; any thread may call status().
class RecordWriter {
public:
    struct Status {
        std::uint64_t records = 0;    ///< Records written, without those of the recovery.
        std::uint64_t conflicts = 0;  ///< Records that differ from the archive's, which are kept.
    };

    /// All objects passed by reference must outlive this.
    RecordWriter(files::FileLayer& files, const Options& options, WaitingRecords& records,
                 Progress& progress, const SpaceReserve& reserve, JournalThread& journal,
                 StationMetadata& metadata, ArchiveHealth& health);

    /// Takes the archive after the replay.
    /// @param session  last session in it, which may continue.
    void begin(std::unique_ptr<archive::Writer> archive,
               const std::optional<journal::SessionId>& session);

    /// Writes and syncs what may be written now; after a fault only at intervals.
    void write();
    /// Writes and syncs everything: the journal is complete, so the archive may use all space.
    void finish();

    [[nodiscard]] Status status() const { return {written_, conflicts_}; }

private:
    [[nodiscard]] bool may_write() const;
    bool try_to_write(bool is_last);
    void write_waiting(bool is_last);
    void write_record(const WaitingRecord& waiting);
    void sync();
    void repair();

    files::FileLayer& files_;
    const Options& options_;
    WaitingRecords& records_;
    Progress& progress_;
    const SpaceReserve& reserve_;
    JournalThread& journal_;
    StationMetadata& metadata_;
    ArchiveHealth& health_;

    std::unique_ptr<archive::Writer> archive_;
    std::optional<journal::SessionId> marked_;  ///< Session of the records in archive_.
    SteadyTime last_sync_;
    Retry retry_;
    std::atomic<std::uint64_t> written_{0}, conflicts_{0};
};

}  // namespace a351::daemon::store
