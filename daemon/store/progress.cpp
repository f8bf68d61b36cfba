#include "daemon/store/progress.hpp"

#include "protocol/core/invariant.hpp"

namespace a351::daemon::store {

void Progress::parsed(std::uint64_t chunk, const journal::SessionId& session,
                      std::optional<std::int64_t> last_index) {
    const std::lock_guard lock(mutex_);
    const bool is_restarted = last_index && indices_.received && *last_index < *indices_.received;
    if (is_restarted) before_restart_ = indices_.received;
    if (indices_.session != session) {
        before_restart_.reset();
        last_synced_ = -1;
    }
    if (indices_.session != session || is_restarted) {
        indices_ = {session, {}, {}, {}};
        unsynced_.clear();
    }
    require_invariant(unsynced_.empty() || chunk > unsynced_.back().chunk,
                      "chunks are parsed in their order, each once");
    if (last_index && last_index != indices_.received) unsynced_.push_back({chunk, *last_index});
    indices_.received = last_index;
    advance();
}

void Progress::journal_written(std::uint64_t chunk) {
    const std::lock_guard lock(mutex_);
    require_invariant(chunk >= written_chunk_, "chunks are written in their order");
    written_chunk_ = chunk;
}

std::uint64_t Progress::written() const {
    const std::lock_guard lock(mutex_);
    return written_chunk_;
}

void Progress::journal_synced(std::uint64_t chunk) {
    const std::lock_guard lock(mutex_);
    require_invariant(chunk >= synced_chunk_, "chunks are synced in their order");
    synced_chunk_ = chunk;
    advance();
}

void Progress::archive_synced(const journal::SessionId& session, std::int64_t index) {
    const std::lock_guard lock(mutex_);
    if (indices_.session != session) return;
    // After a restart of the counter, records of the samples before it can still come.  Their
    // indices never fall and do not exceed the last one, so any other index is of the new samples.
    const bool can_be_older = before_restart_ && index >= last_synced_ && index <= *before_restart_;
    last_synced_ = index;
    if (can_be_older) return;
    before_restart_.reset();
    indices_.archived = index;
}

void Progress::advance() {
    while (!unsynced_.empty() && unsynced_.front().chunk <= synced_chunk_) {
        indices_.journaled = unsynced_.front().last_index;
        unsynced_.pop_front();
    }
}

Progress::Indices Progress::indices() const {
    const std::lock_guard lock(mutex_);
    return indices_;
}

}  // namespace a351::daemon::store
