#pragma once
/// @file
/// The journal thread: what was read goes to disk within 100 ms and survives a power cut after
/// one second, both of real time.  It waits for the disk, and for the archive
/// thread when ChunkQueue is full.  What a full disk refuses costs the reserve first; of what it
/// refuses for longer than the queue of reads can hold, the newest is kept.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "daemon/source/host_clock.hpp"
#include "daemon/source/read_queue.hpp"
#include "daemon/store/chunk_queue.hpp"
#include "daemon/store/disk_time.hpp"
#include "daemon/store/progress.hpp"
#include "daemon/store/space_reserve.hpp"
#include "protocol/events/event_log.hpp"
#include "protocol/files/file_layer.hpp"
#include "protocol/journal/journal_writer.hpp"

namespace a351::daemon {

struct JournalStatus {
    bool is_faulty = false;  ///< Now, or within the last retry interval: long enough to be seen.
    std::string trouble;     ///< The last fault of the disk.
    std::uint64_t faults = 0;
    std::uint64_t bytes_written = 0;
    std::uint64_t rounds = 0;                   ///< Of the thread.
    std::uint64_t archive_waits = 0;            ///< Times it had to wait for the archive.
    std::uint64_t events_refused = 0;           ///< That the event log did not take.
    std::uint64_t reads_dropped = 0;            ///< That the disk refused for too long.
    std::chrono::milliseconds longest_sync{0};  ///< Or write; one under way counts.
    std::chrono::milliseconds present_sync{0};  ///< The one under way; 0: none.
};

class JournalThread {
public:
    /// All referred to must outlive this.
    JournalThread(record::FileLayer& files, const std::filesystem::path& data_root,
                  const HostClock& clock, ReadQueue& reads, ChunkQueue& written, Progress& progress,
                  SpaceReserve& reserve, DiskTime time);
    ~JournalThread();

    void start();

    /// One round in the caller's thread, for who does without start().
    void step() noexcept { go_round(Phase::running); }

    /// Writes what is left in the queues, closes `written`, and goes on until finish().
    void drain();
    /// Writes what was posted meanwhile, syncs, and ends.
    /// @return false when something could not be written.
    bool finish();

    /// A chunk to be written soon: MARK, MODEL.
    void post(record::JournalChunk chunk);

    /// Waits until the event log holds the event, synced; the journal has it then too, or as soon
    /// as it can be written.
    /// @throws std::system_error  what kept it out of the event log: nothing of it is written;
    ///                            timed_out when its turn did not come within `patience`: then it is
    ///                            withdrawn.
    void commit(const record::Event& event, std::chrono::milliseconds patience);

    [[nodiscard]] JournalStatus status() const;

private:
    enum class Phase { running, draining, finishing };
    struct Commit {
        record::Event event;
        std::promise<void> done;
    };

    void run() noexcept;
    void go_round(Phase phase) noexcept;
    void work(Phase phase);
    void make_room();
    void write_reads();
    [[nodiscard]] bool is_clock_due() const;
    void write_clock(const timing::ClockReading& reading);
    [[nodiscard]] std::optional<record::JournalChunk> next_posted();
    void write(record::JournalChunk chunk);
    void retry_unwritten();
    void hand_over(record::JournalChunk chunk);
    void carry_out_commits();
    void carry_out(Commit& commit);
    void sync();
    void on_disk(const std::function<void()>& operation);
    void note_fault(const std::string& trouble);
    [[nodiscard]] bool may_try_again() const;
    [[nodiscard]] bool is_fault_recent() const;

    DiskTime time_;
    record::FileLayer& files_;
    std::filesystem::path events_;
    const HostClock& clock_;
    ReadQueue& reads_;
    ChunkQueue& written_;
    Progress& progress_;
    SpaceReserve& reserve_;
    record::JournalWriter writer_;

    bool is_started_ = false;  ///< Else the caller's thread does the work.

    // Of the journal thread.
    bool has_segment_ = false;
    bool is_dirty_ = false;
    int faults_running_ = 0;                         ///< Since the last good sync.
    std::optional<record::JournalChunk> unwritten_;  ///< What the disk refused.
    std::uint64_t last_chunk_ = 0;
    RawTime last_clock_;
    std::chrono::steady_clock::time_point last_clock_real_, last_sync_;

    mutable std::mutex mutex_;
    std::condition_variable woken_;
    Phase phase_ = Phase::running;
    bool is_drained_ = false;
    std::deque<record::JournalChunk> posted_;
    std::deque<std::shared_ptr<Commit>> commits_;
    JournalStatus status_;
    std::optional<std::chrono::steady_clock::time_point> on_disk_since_, last_fault_;
    std::thread thread_;
};

}  // namespace a351::daemon
