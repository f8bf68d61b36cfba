#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

#include "protocol/journal/journal.hpp"

namespace a351::daemon {

/// A chunk that is written to the journal (not yet synced), by its number since start.
struct NumberedChunk {
    std::uint64_t number = 0;
    record::JournalChunk chunk;
};

/// From the journal thread to the archive thread.
class ChunkQueue {
public:
    /// 32 MiB of chunks: about three quarters of an hour at 50 Hz, 20 chunks a
    /// second of some 600 bytes.
    static constexpr std::size_t kCapacityBytes = std::size_t{32} << 20;

    explicit ChunkQueue(std::size_t capacity_bytes = kCapacityBytes);

    /// Waits while the queue is full: the journal must not run ahead of what memory holds.
    /// @return false when it had to wait.
    bool push(NumberedChunk chunk);

    /// Waits for a chunk; std::nullopt once the queue is closed and empty.
    [[nodiscard]] std::optional<NumberedChunk> pop();

    /// Does not wait.
    [[nodiscard]] std::optional<NumberedChunk> try_pop();

    [[nodiscard]] bool is_half_full() const;

    /// No chunk will follow; one that does is dropped.
    void close();

private:
    std::optional<NumberedChunk> take_front();

    std::size_t capacity_bytes_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<NumberedChunk> chunks_;
    std::size_t bytes_ = 0;
    bool is_closed_ = false;
};

}  // namespace a351::daemon
