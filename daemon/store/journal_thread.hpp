#pragma once
/// @file
/// The journal thread.  Received bytes go to disk within 100 ms and survive a power cut after
/// one second, both in real time.  The thread waits for the disk, and for the archive thread when
/// ChunkQueue is full.  When the disk is full, the reserve is used first.  If writing fails for
/// longer than the queue of reads can store, the newest reads are kept.

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

#include "daemon/source/host_clock.hpp"
#include "daemon/source/read_queue.hpp"
#include "daemon/store/chunk_queue.hpp"
#include "daemon/store/progress.hpp"
#include "daemon/store/space_reserve.hpp"
#include "protocol/events/event_log.hpp"
#include "protocol/files/file_layer.hpp"
#include "protocol/journal/journal_writer.hpp"

namespace a351::daemon::store {

struct JournalStatus {
    bool is_faulty = false;  ///< A fault now or within the last retry interval, so that it is seen.
    std::string trouble;     ///< Text of the last disk fault.
    std::uint64_t faults = 0;
    std::uint64_t bytes_written = 0;
    std::uint64_t rounds = 0;                   ///< Rounds of the thread.
    std::uint64_t archive_waits = 0;            ///< Number of times it had to wait for the archive.
    std::uint64_t events_refused = 0;           ///< Events not written to the event log.
    std::uint64_t reads_dropped = 0;            ///< Reads dropped, writing failed for too long.
    std::chrono::milliseconds longest_sync{0};  ///< Longest sync or write, or one in progress.
    std::chrono::milliseconds present_sync{0};  ///< Duration of the one in progress; 0: none.
};

class JournalThread {
public:
    /// All objects passed by reference must outlive this.
    JournalThread(files::FileLayer& files, const std::filesystem::path& data_root,
                  const source::HostClock& clock, source::ReadQueue& reads, ChunkQueue& written,
                  Progress& progress, SpaceReserve& reserve, DiskTime time);
    ~JournalThread();

    void start();

    /// Runs one round in the caller's thread; for tests that do not call start().
    void step() noexcept { run_once(Phase::running); }

    /// Writes everything left in the queues and closes `written`; the thread continues until
    /// finish().
    void drain();
    /// Writes the chunks posted meanwhile, syncs, and ends the thread.
    /// @return false if something could not be written.
    bool finish();

    /// Queues a chunk to be written soon: MARK, MODEL or a poll of the oven.
    void post(journal::Chunk chunk);

    /// Writes the event and waits until it is in the event log and synced.  The journal contains it
    /// then too, or as soon as the journal can be written.
    /// @throws std::system_error  the event could not be written, and nothing of it is in the event
    ///                            log; timed_out if its turn did not come within `patience`: it is
    ///                            then withdrawn.
    void commit(const events::Event& event, std::chrono::milliseconds patience);

    [[nodiscard]] JournalStatus status() const;

private:
    enum class Phase { running, draining, finishing };
    struct Commit {
        events::Event event;
        std::promise<void> done;
    };

    void run() noexcept;
    void run_once(Phase phase) noexcept;
    void work(Phase phase);
    void make_room();
    void write_reads();
    [[nodiscard]] bool is_clock_due() const;
    void write_clock(const timing::ClockReading& reading);
    template <class Item>
    [[nodiscard]] std::optional<Item> take_first(std::deque<Item>& items);
    void write(journal::Chunk chunk);
    void retry_unwritten();
    void hand_over(journal::Chunk chunk);
    void carry_out(Commit& commit);
    void sync();
    void on_disk(const std::function<void()>& operation);
    void note_fault(const std::string& trouble);
    [[nodiscard]] bool may_try_again() const;
    [[nodiscard]] bool is_fault_recent() const;

    DiskTime time_;
    files::FileLayer& files_;
    std::filesystem::path events_;
    const source::HostClock& clock_;
    source::ReadQueue& reads_;
    ChunkQueue& written_;
    Progress& progress_;
    SpaceReserve& reserve_;
    journal::Writer writer_;

    bool is_started_ = false;  ///< If false, the caller's thread does the work.

    // Used by the journal thread only.
    bool has_segment_ = false;
    bool is_dirty_ = false;
    int faults_running_ = 0;                   ///< Faults since the last successful sync.
    std::optional<journal::Chunk> unwritten_;  ///< Chunk that could not be written yet.
    std::uint64_t last_chunk_ = 0;
    RawTime last_clock_;
    std::chrono::steady_clock::time_point last_clock_real_, last_sync_;

    mutable std::mutex mutex_;
    std::condition_variable woken_;
    Phase phase_ = Phase::running;
    bool is_drained_ = false;
    std::deque<journal::Chunk> posted_;
    std::deque<std::shared_ptr<Commit>> commits_;
    JournalStatus status_;
    std::optional<std::chrono::steady_clock::time_point> on_disk_since_, last_fault_;
    std::thread thread_;
};

}  // namespace a351::daemon::store
