#pragma once
/// @file
/// Everything between the reader's queue and the disk: recovery at start, journal, archive,
/// station metadata, events; and what the survey and the page ask of the record.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>

#include "daemon/source/host_clock.hpp"
#include "daemon/source/read_queue.hpp"
#include "daemon/status/status.hpp"
#include "daemon/store/archive_thread.hpp"
#include "daemon/store/chunk_queue.hpp"
#include "daemon/store/data_root.hpp"
#include "daemon/store/disk_time.hpp"
#include "daemon/store/journal_keeper.hpp"
#include "daemon/store/journal_thread.hpp"
#include "daemon/store/progress.hpp"
#include "daemon/store/space_reserve.hpp"
#include "daemon/survey/recorder.hpp"
#include "protocol/archive/recovery.hpp"
#include "protocol/files/file_layer.hpp"
#include "protocol/journal/journal.hpp"
#include "protocol/journal/stream_end.hpp"
#include "protocol/station/station_xml.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::daemon {

struct StoreOptions {
    std::filesystem::path root;
    /// What the configuration knows of the station; device and instants come with each session.
    record::StationDescription station = {};
    DiskTime time = {};
    std::uint64_t reserve_bytes = SpaceReserve::kSize_bytes;
    std::size_t queue_bytes = ChunkQueue::kCapacityBytes;
    JournalKeeper::Options keeper = {};
    /// How long an event waits for its turn.
    std::chrono::milliseconds commit_patience{10'000};
    /// Called by another thread when the archive is up to the journal of the last run.
    std::function<void(const record::RecoveryReport&)> recovered = [](const auto&) {};
    /// Both by another thread: once before anything is recorded or recovered, and it must not
    /// throw; and with each sample that gets its place, those of the last run's journal included.
    std::function<void()> begin = [] {};
    std::function<void(const record::Sample&, UtcTime)> sample = [](const auto&, UtcTime) {};
};

class Store : public Recorder {
public:
    /// Locks the data root and mends its journal.  `files`, `clock` and `reads` must outlive this.
    /// @throws DataRootLocked, std::system_error
    Store(record::FileLayer& files, StoreOptions options, const HostClock& clock, ReadQueue& reads);
    ~Store() override;

    /// Where the stream stands that the journal knows.
    [[nodiscard]] const std::optional<record::StreamEnd>& known_stream() const noexcept {
        return known_stream_;
    }

    /// Records from now on; the archive is recovered meanwhile.
    void start();

    /// Instead of start(): does in the caller's thread what journal and archive thread would do.
    void step();

    /// Writes what the reader left in its queue, closes and syncs everything.
    /// @return false when something could not be written.
    bool stop();

    [[nodiscard]] std::optional<Instant> latest() override;
    [[nodiscard]] std::optional<Instant> at(UtcTime utc) override;
    void commit(const record::Event& event) override;

    /// A poll for the journal; dropped before the sensor's first session, which opens it.
    void post(record::OvenChunk poll) { journal_.post(std::move(poll)); }

    /// Whether the journal thread came round since the last call, or waits for the disk: what is
    /// read then waits in memory, which a restart would lose.
    [[nodiscard]] bool has_come_round();

    /// Fills in what the store knows.
    void fill(Status& status);

private:
    record::RecoveryPlan plan_recovery();
    void go_on(const record::RecoveryReport& report);
    void describe(const record::JournalHeader& header);

    record::FileLayer& files_;
    StoreOptions options_;
    DataRootLock lock_;
    JournalKeeper keeper_;
    SpaceReserve reserve_;
    record::RecoveryPlan plan_;
    std::optional<record::StreamEnd> known_stream_;
    const wire::DeviceProfile* profile_;
    Progress progress_;
    ChunkQueue chunks_;
    JournalThread journal_;
    ArchiveThread archive_;
    std::mutex metadata_mutex_;
    std::string metadata_trouble_;
    bool is_running_ = false;
    std::uint64_t rounds_ = 0;  ///< Of the journal thread, when it was last asked for.
};

}  // namespace a351::daemon
