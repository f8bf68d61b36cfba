#include "daemon/store/chunk_queue.hpp"

#include "protocol/core/invariant.hpp"

namespace a351::daemon::store {

std::size_t size_of(const NumberedChunk& numbered) {
    std::size_t size = sizeof numbered;
    if (const auto* rx = std::get_if<journal::RxChunk>(&numbered.chunk))
        size += rx->bytes.size() + rx->reads.size() * sizeof(journal::ReadStamp);
    return size;
}

bool ChunkQueue::push(NumberedChunk chunk) {
    std::unique_lock lock(mutex_);
    const bool has_room = bytes_ < capacity_bytes_;
    changed_.wait(lock, [this] { return is_closed_ || bytes_ < capacity_bytes_; });
    if (is_closed_) return true;
    bytes_ += size_of(chunk);
    chunks_.push_back(std::move(chunk));
    changed_.notify_all();
    return has_room;
}

std::optional<NumberedChunk> ChunkQueue::pop() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return is_closed_ || !chunks_.empty(); });
    return take_front();
}

std::optional<NumberedChunk> ChunkQueue::try_pop() {
    const std::lock_guard lock(mutex_);
    return take_front();
}

std::optional<NumberedChunk> ChunkQueue::take_front() {
    if (chunks_.empty()) return std::nullopt;
    NumberedChunk chunk = std::move(chunks_.front());
    chunks_.pop_front();
    const bool was_full = bytes_ >= capacity_bytes_;
    const std::size_t size = size_of(chunk);
    require_invariant(bytes_ >= size && (!chunks_.empty() || bytes_ == size),
                      "the bytes of the archive's queue are those of its chunks");
    bytes_ -= size;
    if (was_full) changed_.notify_all();
    return chunk;
}

bool ChunkQueue::is_half_full() const {
    const std::lock_guard lock(mutex_);
    return bytes_ >= capacity_bytes_ / 2;
}

void ChunkQueue::close() {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
    changed_.notify_all();
}

}  // namespace a351::daemon::store
