#include "daemon/store/progress.hpp"

namespace a351::daemon {

void Progress::parsed(std::uint64_t chunk, const record::SessionId& session,
                      std::optional<std::int64_t> last_index) {
    const std::lock_guard lock(mutex_);
    if (indices_.session != session) {
        indices_ = {session, {}, {}, {}};
        unsynced_.clear();
        lost_chunk_ = 0;
    }
    parsed_chunk_ = chunk;
    if (chunk <= lost_chunk_) lost_index_ = last_index;
    if (last_index && last_index != indices_.received) unsynced_.push_back({chunk, *last_index});
    indices_.received = last_index;
    advance();
}

void Progress::journal_synced(std::uint64_t chunk) {
    const std::lock_guard lock(mutex_);
    synced_chunk_ = chunk;
    advance();
}

void Progress::journal_lost(std::uint64_t chunk) {
    const std::lock_guard lock(mutex_);
    lost_chunk_ = chunk;
    lost_index_ = indices_.received;
}

void Progress::archive_synced(const record::SessionId& session, std::int64_t index) {
    const std::lock_guard lock(mutex_);
    if (indices_.session != session) return;
    indices_.archived = index;
    advance();
}

void Progress::advance() {
    if (lost_chunk_ != 0) {
        const bool is_archived =
            !lost_index_ || (indices_.archived && *indices_.archived >= *lost_index_);
        if (parsed_chunk_ < lost_chunk_ || !is_archived) return;
        lost_chunk_ = 0;
    }
    while (!unsynced_.empty() && unsynced_.front().chunk <= synced_chunk_) {
        indices_.journaled = unsynced_.front().last_index;
        unsynced_.pop_front();
    }
}

Progress::Indices Progress::indices() const {
    const std::lock_guard lock(mutex_);
    return indices_;
}

}  // namespace a351::daemon
