#include "daemon/store/chunk_list.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "protocol/core/invariant.hpp"

namespace a351::daemon::store {
namespace {

// Most removed chunks of a kind that are kept: those of 1.6 s at 20 per second.
constexpr std::size_t kMostSpare = 32;

/// Copies `from` into the memory of a removed chunk.  Reserves powers of two, because the number of
/// reads differs from chunk to chunk.
void copy_into(journal::Chunk& to, const journal::Chunk& from) {
    if (const auto* const rx = std::get_if<journal::RxChunk>(&from)) {
        auto& used = std::get<journal::RxChunk>(to);
        used.bytes.reserve(std::bit_ceil(rx->bytes.size()));
        used.reads.reserve(std::bit_ceil(rx->reads.size()));
    }
    to = from;
}

}  // namespace

std::size_t size_of(const journal::Chunk& chunk) {
    std::size_t size = sizeof(NumberedChunk);
    if (const auto* rx = std::get_if<journal::RxChunk>(&chunk))
        size += rx->bytes.size() + rx->reads.size() * sizeof(journal::ReadStamp);
    return size;
}

void ChunkList::push(std::uint64_t number, const journal::Chunk& chunk) {
    auto& spare = spare_.at(chunk.index());
    if (spare.empty()) {
        chunks_.push_back({number, chunk});
    } else {
        copy_into(spare.back().chunk, chunk);
        spare.back().number = number;
        chunks_.splice(chunks_.end(), spare, std::prev(spare.end()));
    }
    bytes_ += size_of(chunk);
}

bool ChunkList::pop(NumberedChunk& next) {
    if (chunks_.empty()) return false;
    count_out(chunks_.front().chunk);
    std::swap(chunks_.front(), next);
    auto& spare = spare_.at(chunks_.front().chunk.index());
    if (spare.size() < kMostSpare)
        spare.splice(spare.end(), chunks_, chunks_.begin());
    else
        chunks_.pop_front();
    return true;
}

void ChunkList::erase(std::list<NumberedChunk>::const_iterator chunk) {
    count_out(chunk->chunk);
    chunks_.erase(chunk);
}

/// Must be called before the chunk is removed.
void ChunkList::count_out(const journal::Chunk& chunk) {
    const std::size_t size = size_of(chunk);
    require_invariant(bytes_ >= size && (chunks_.size() > 1 || bytes_ == size),
                      "the bytes of a queue are those of its chunks");
    bytes_ -= size;
}

}  // namespace a351::daemon::store
