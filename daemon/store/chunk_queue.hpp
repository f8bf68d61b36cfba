#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

#include "protocol/journal/journal.hpp"

namespace a351::daemon::store {

/// A chunk for journal and archive, with its number since start, from 1.
struct NumberedChunk {
    std::uint64_t number = 0;  ///< 0: for the journal only.
    journal::Chunk chunk;
};

/// Returns the memory that a chunk takes, about its size in the journal.
[[nodiscard]] std::size_t size_of(const NumberedChunk& numbered);

/// The queue from ChunkMaker to the archive thread.
class ChunkQueue {
public:
    /// Capacity: 32 MiB of chunks, about three quarters of an hour at 50 Hz (20 chunks a second of
    /// about 600 bytes).
    static constexpr std::size_t kCapacityBytes = std::size_t{32} << 20;

    explicit ChunkQueue(std::size_t capacity_bytes = kCapacityBytes)
        : capacity_bytes_(capacity_bytes) {}

    /// Appends a chunk.  Waits while the queue is full.
    /// @return false if it had to wait.
    bool push(NumberedChunk chunk);

    /// Waits for a chunk and removes it.  @return std::nullopt once the queue is closed and empty.
    [[nodiscard]] std::optional<NumberedChunk> pop();

    /// Removes a chunk without waiting.  @return std::nullopt if there is none.
    [[nodiscard]] std::optional<NumberedChunk> try_pop();

    [[nodiscard]] bool is_half_full() const;

    /// Declares that no chunk follows; later chunks are dropped.
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

}  // namespace a351::daemon::store
