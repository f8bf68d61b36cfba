#pragma once
/// @file
/// Makes the chunks of the journal from the reader's queue, the host's clock and the ovens' polls.
/// Each chunk goes to the journal thread and to the archive thread at the same time.  This thread
/// never accesses the disk, so the live view continues while the disk hangs or refuses data.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "daemon/source/host_clock.hpp"
#include "daemon/source/read_queue.hpp"
#include "daemon/store/chunk_queue.hpp"
#include "daemon/store/disk_policy.hpp"
#include "daemon/store/journal_thread.hpp"

namespace a351::daemon::store {

class ChunkMaker {
public:
    struct Status {
        std::uint64_t rounds = 0;         ///< Rounds of the thread.
        std::uint64_t archive_waits = 0;  ///< Number of times it had to wait for the archive.
    };

    /// All objects passed by reference must outlive this.
    ChunkMaker(const source::HostClock& clock, source::ReadQueue& reads, JournalThread& journal,
               ChunkQueue& decoded, DiskTime time);
    ~ChunkMaker();

    void start();

    /// Runs one round in the caller's thread; for tests that do not call start().
    void step();

    /// Makes chunks of everything left, closes the archive's queue, and ends the thread.
    void drain();

    /// Queues a poll of an oven.  It is dropped before the first session.
    void post(journal::OvenChunk poll);

    [[nodiscard]] Status status() const;

private:
    void run();
    void make_chunks();
    [[nodiscard]] bool is_clock_due() const;
    void pass_clock(const timing::ClockReading& reading);
    [[nodiscard]] bool is_segment_full(const journal::Chunk& next) const;
    void pass(const journal::Chunk& chunk);

    const source::HostClock& clock_;
    source::ReadQueue& reads_;
    JournalThread& journal_;
    ChunkQueue& decoded_;
    DiskTime time_;

    // Used by this thread only.
    journal::Chunk rx_ = journal::RxChunk{};         ///< Chunk of reads that is being made.
    std::vector<journal::OvenChunk> polls_to_pass_;  ///< Empty between two rounds.
    std::optional<journal::Header> header_;          ///< Header of the newest segment.
    std::uint64_t segment_bytes_ = 0;                ///< Its size so far.
    std::uint64_t last_number_ = 0;
    RawTime last_clock_;
    std::chrono::steady_clock::time_point last_clock_real_;

    mutable std::mutex mutex_;
    std::condition_variable woken_;
    bool is_ending_ = false;
    std::vector<journal::OvenChunk> polls_;
    Status status_;
    std::thread thread_;
};

}  // namespace a351::daemon::store
