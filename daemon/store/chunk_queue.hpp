#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>

#include "daemon/store/chunk_list.hpp"

namespace a351::daemon::store {

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
    bool push(std::uint64_t number, const journal::Chunk& chunk);

    /// Waits for a chunk and moves it to `next`.  @return false once the queue is closed and empty.
    [[nodiscard]] bool pop(NumberedChunk& next);

    /// Moves a chunk to `next` without waiting.  @return false if there is none.
    [[nodiscard]] bool try_pop(NumberedChunk& next);

    [[nodiscard]] bool is_half_full() const;

    /// Declares that no chunk follows; later chunks are dropped.
    void close();

private:
    bool take_front(NumberedChunk& next);

    std::size_t capacity_bytes_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    ChunkList chunks_;
    bool is_closed_ = false;
};

}  // namespace a351::daemon::store
