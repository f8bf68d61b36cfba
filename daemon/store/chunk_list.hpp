#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <list>
#include <variant>

#include "protocol/journal/journal.hpp"

namespace a351::daemon::store {

/// A chunk for journal and archive, with its number since start, from 1.
struct NumberedChunk {
    std::uint64_t number = 0;  ///< 0: for the journal only.
    journal::Chunk chunk;
};

/// Returns the memory that a chunk takes, about its size in the journal.
[[nodiscard]] std::size_t size_of(const journal::Chunk& chunk);

/// Chunks in their order.  The memory of removed ones is used again: at a steady rate, with chunks
/// of usual size, nothing is allocated.
class ChunkList {
public:
    void push(std::uint64_t number, const journal::Chunk& chunk);

    /// Moves the oldest chunk to `next`; the memory of the chunk that was there is used again.
    /// @return false if there is none.
    [[nodiscard]] bool pop(NumberedChunk& next);

    void erase(std::list<NumberedChunk>::const_iterator chunk);

    [[nodiscard]] const std::list<NumberedChunk>& chunks() const noexcept { return chunks_; }

    /// Returns the memory of all chunks, by size_of().
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }

private:
    void count_out(const journal::Chunk& chunk);

    std::list<NumberedChunk> chunks_;
    /// Removed chunks by kind, because a chunk of another kind cannot use their memory.
    std::array<std::list<NumberedChunk>, std::variant_size_v<journal::Chunk>> spare_;
    std::size_t bytes_ = 0;
};

}  // namespace a351::daemon::store
