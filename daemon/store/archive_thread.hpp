#pragma once
/// @file
/// From chunks to samples, times and miniSEED records, by two threads.  The first decodes, and never
/// waits for the disk once the chunks that the last run left in the journal are processed;
/// acquisition does not wait for them.  The second writes a record when the journal holds its chunk.
/// disk_policy.hpp says what they do when a disk is full or fails.
///
///     first thread:   ArchiveRecovery, then ChunkQueue -> Decoder -> WaitingRecords
///     second thread:  WaitingRecords -> RecordWriter -> day files, MARK in the journal

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "daemon/store/archive_health.hpp"
#include "daemon/store/archive_recovery.hpp"
#include "daemon/store/chunk_queue.hpp"
#include "daemon/store/decoder.hpp"
#include "daemon/store/options.hpp"
#include "daemon/store/record_writer.hpp"
#include "daemon/store/station_metadata.hpp"
#include "daemon/store/waiting_records.hpp"

namespace a351::daemon::store {

struct ArchiveStatus : ArchiveHealth::Status, Decoder::Status, RecordWriter::Status {
    bool is_replaying = false;  ///< The last run's journal is being added to the archive.
    std::uint64_t records_waiting = 0;
    std::string metadata_trouble;
};

class ArchiveThread {
public:
    /// All objects passed by reference must outlive this.
    ArchiveThread(files::FileLayer& files, const Options& options, const source::HostClock& clock,
                  ChunkQueue& chunks, Progress& progress, SpaceReserve& reserve,
                  JournalThread& journal, JournalKeeper& keeper, const archive::RecoveryPlan& plan);
    ~ArchiveThread();

    void start();

    /// Processes pending input in the caller's thread; for tests that do not call start().
    void step();

    /// Ends all waiting from now on: a fault at the end is retried once, and a replay is left to
    /// the next start.
    void skip_waits();

    /// Waits until the queue is closed and everything is in the archive, synced and marked.
    /// @return false if something could not be written.
    bool join();

    [[nodiscard]] std::optional<survey::Instant> latest() const;
    [[nodiscard]] std::optional<survey::Instant> at(UtcTime utc) const;
    void set_day_end(UtcTime end) { decoder_.set_day_end(end); }
    [[nodiscard]] Nanoseconds signal_since(const journal::SessionId& session,
                                           std::int64_t index) const;
    [[nodiscard]] ArchiveStatus status() const;

private:
    void run() noexcept;
    void run_writing() noexcept;
    void handle(const NumberedChunk& numbered) noexcept;
    void wait_for_room();
    void look_at_space();
    bool wait(std::chrono::milliseconds longest, const std::atomic<bool>& is_over);

    const Options& options_;
    ChunkQueue& chunks_;
    SpaceReserve& reserve_;

    std::atomic<bool> is_hurried_{false};
    std::atomic<bool> is_ending_{false};  ///< All is decoded, and in the journal if it could be.
    WaitingRecords records_;
    ArchiveHealth health_;
    StationMetadata metadata_;
    Decoder decoder_;
    RecordWriter writer_;
    ArchiveRecovery recovery_;
    SteadyTime last_look_at_space_;  ///< Used by the writing thread only.

    std::mutex mutex_;  ///< For changed_, which announces is_hurried_ and is_ending_.
    std::condition_variable changed_;
    std::thread thread_, writing_thread_;
};

}  // namespace a351::daemon::store
