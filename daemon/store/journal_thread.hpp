#pragma once
/// @file
/// The journal thread.  Received bytes go to disk within 0.2 s and survive a power cut after
/// 0.95 s and the time of a sync, in real time (a351d(1), DATA THAT CAN BE LOST).  Only this thread
/// waits for the journal's disk.  What it does on a full or failing disk is in disk_policy.hpp.

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

#include "daemon/store/chunk_list.hpp"
#include "daemon/store/progress.hpp"
#include "daemon/store/space_reserve.hpp"
#include "protocol/events/event_log.hpp"
#include "protocol/files/file_layer.hpp"
#include "protocol/journal/journal_writer.hpp"

namespace a351::daemon::store {

struct JournalStatus {
    /// Text of a disk fault now or within the last retry interval, so that it is seen.
    std::string trouble;
    std::uint64_t faults = 0;
    std::uint64_t bytes_written = 0;
    std::uint64_t rounds = 0;                   ///< Rounds of the thread.
    std::uint64_t events_refused = 0;           ///< Events not written to the event log.
    std::uint64_t reads_dropped = 0;            ///< Reads dropped, writing failed for too long.
    bool is_dropping = false;                   ///< Chunks were dropped since the last good sync.
    std::chrono::milliseconds longest_sync{0};  ///< Longest sync or write, or one in progress.
    std::chrono::milliseconds present_sync{0};  ///< Duration of the one in progress; 0: none.
};

class JournalThread {
public:
    /// All objects passed by reference must outlive this.
    /// @param capacity_bytes  of chunks that wait to be written.
    JournalThread(files::FileLayer& files, const std::filesystem::path& data_root,
                  std::size_t capacity_bytes, Progress& progress, SpaceReserve& reserve,
                  DiskTime time);
    ~JournalThread();

    void start();

    /// Runs one round in the caller's thread; for tests that do not call start().
    void step() noexcept { run_once(Phase::running); }

    /// Writes everything left in the queue; the thread continues until finish().
    void drain();
    /// Writes the chunks pushed meanwhile, syncs, and ends the thread.
    /// @return false if something could not be written.
    bool finish();

    /// Queues a chunk to be written soon.  If the journal is stuck and the queue full, the oldest
    /// reads, clock readings and polls are dropped.
    /// @param number  number of the chunk; 0: for the journal only.
    void push(std::uint64_t number, const journal::Chunk& chunk);

    /// Returns false if the queue is full because the disk is slow: the caller should wait.
    [[nodiscard]] bool has_room() const;

    /// Writes the event and waits until it is in the event log and synced.  The journal contains it
    /// then too, or as soon as the journal can be written.
    /// @throws std::system_error  the event could not be written, and nothing of it is in the event
    ///                            log; timed_out if its turn did not come within `patience`: it is
    ///                            then withdrawn.
    void commit(const events::Event& event, std::chrono::milliseconds patience);

    /// Queues an event like commit() and does not wait.  It is lost if it cannot be written; the
    /// status counts it as refused.
    void note(const events::Event& event);

    [[nodiscard]] JournalStatus status() const;

private:
    enum class Phase { running, draining, finishing };
    struct Commit {
        events::Event event;
        std::promise<void> done;
    };

    void run() noexcept;
    void run_once(Phase phase) noexcept;
    void work();
    void write_queued();
    void retry_unwritten();
    [[nodiscard]] bool take_next();
    [[nodiscard]] std::shared_ptr<Commit> next_commit();
    [[nodiscard]] Overflow overflow() const;
    [[nodiscard]] std::chrono::milliseconds present_operation() const;
    [[nodiscard]] bool drop_oldest();
    void carry_out(Commit& commit);
    void sync();
    void on_disk(const std::function<void()>& operation);
    void note_fault(const std::string& trouble);
    [[nodiscard]] bool may_try_again() const;

    DiskTime time_;
    files::FileLayer& files_;
    std::filesystem::path events_;
    std::size_t capacity_bytes_;
    Progress& progress_;
    SpaceReserve& reserve_;
    journal::Writer writer_;

    bool is_started_ = false;  ///< If false, the caller's thread does the work.

    // Used by the journal thread only.
    bool has_segment_ = false;
    bool is_dirty_ = false;
    NumberedChunk taken_;           ///< Chunk that was taken from the queue last.
    bool is_unwritten_ = false;     ///< That chunk could not be written yet.
    std::uint64_t last_chunk_ = 0;  ///< Number of the last chunk that was written.
    SteadyTime last_sync_;

    mutable std::mutex mutex_;
    std::condition_variable woken_;
    Phase phase_ = Phase::running;
    bool is_drained_ = false;
    bool has_news_ = false;  ///< A chunk was pushed since the last round.
    ChunkList queued_;
    Retry retry_;  ///< Its successes are syncs.  At once after one fault: a new segment may do.
    std::deque<std::shared_ptr<Commit>> commits_;
    JournalStatus status_;
    std::optional<SteadyTime> on_disk_since_;
    std::thread thread_;
};

}  // namespace a351::daemon::store
