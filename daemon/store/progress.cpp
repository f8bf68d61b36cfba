#include "daemon/store/progress.hpp"

#include <algorithm>

namespace a351::daemon {
namespace {

constexpr std::uint64_t kCoarse = 50;  // chunks: some seconds

}  // namespace

void Progress::parsed(std::uint64_t chunk, const record::SessionId& session,
                      std::optional<std::int64_t> last_index) {
    const std::lock_guard lock(mutex_);
    if (indices_.session != session) {
        indices_ = {session, {}, {}, {}};
        unsynced_.clear();
    }
    if (last_index && last_index != indices_.received) unsynced_.push_back({chunk, *last_index});
    indices_.received = last_index;
    if (last_index && (unmarked_.empty() || unmarked_.back().session != session ||
                       chunk - unmarked_.back().parsed.chunk >= kCoarse)) {
        unmarked_.push_back({session, {chunk, *last_index}});
    }
    advance();
}

void Progress::journal_synced(std::uint64_t chunk) {
    const std::lock_guard lock(mutex_);
    synced_chunk_ = chunk;
    advance();
}

void Progress::archive_synced(const record::SessionId& session, std::int64_t index) {
    const std::lock_guard lock(mutex_);
    if (indices_.session != session) return;
    indices_.archived = index;
}

void Progress::mark_synced(const record::SessionId& session, std::int64_t index) {
    const std::lock_guard lock(mutex_);
    const auto is_of_session = [&](const Unmarked& u) { return u.session == session; };
    // What lies before the first of the session belongs to older ones, which are complete.
    auto end = std::find_if(unmarked_.begin(), unmarked_.end(), is_of_session);
    if (end == unmarked_.end()) return;
    while (end != unmarked_.end() && is_of_session(*end) && end->parsed.last_index <= index) ++end;
    if (end == unmarked_.begin()) return;
    marked_chunk_ = std::prev(end)->parsed.chunk;
    unmarked_.erase(unmarked_.begin(), end);
}

std::uint64_t Progress::marked_chunk() const {
    const std::lock_guard lock(mutex_);
    return marked_chunk_;
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

}  // namespace a351::daemon
