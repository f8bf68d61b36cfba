#include "daemon/store/chunk_queue.hpp"

namespace a351::daemon::store {

bool ChunkQueue::push(std::uint64_t number, const journal::Chunk& chunk) {
    std::unique_lock lock(mutex_);
    const bool has_room = chunks_.bytes() < capacity_bytes_;
    changed_.wait(lock, [this] { return is_closed_ || chunks_.bytes() < capacity_bytes_; });
    if (is_closed_) return true;
    chunks_.push(number, chunk);
    lock.unlock();
    changed_.notify_all();
    return has_room;
}

bool ChunkQueue::pop(NumberedChunk& next) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return is_closed_ || !chunks_.chunks().empty(); });
    return take_front(next);
}

bool ChunkQueue::try_pop(NumberedChunk& next) {
    const std::lock_guard lock(mutex_);
    return take_front(next);
}

bool ChunkQueue::take_front(NumberedChunk& next) {
    const bool was_full = chunks_.bytes() >= capacity_bytes_;
    const bool is_taken = chunks_.pop(next);
    if (was_full) changed_.notify_all();
    return is_taken;
}

bool ChunkQueue::is_half_full() const {
    const std::lock_guard lock(mutex_);
    return chunks_.bytes() >= capacity_bytes_ / 2;
}

void ChunkQueue::close() {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
    changed_.notify_all();
}

}  // namespace a351::daemon::store
