#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "daemon/store/progress.hpp"
#include "protocol/archive/miniseed.hpp"
#include "protocol/journal/journal.hpp"

namespace a351::daemon::store {

struct WaitingRecord {
    std::uint64_t chunk = 0;  ///< The journal must hold this chunk first; 0: it does.
    std::optional<journal::SessionId> session;
    std::string channel;
    archive::PackedRecord record;
    std::int64_t last_index = 0;  ///< Index of its last sample.
};

/// The records between the thread that decodes and the thread that writes, in order.
///
/// Thread-safe.  The lock is never held for disk access.
class WaitingRecords {
public:
    /// @param progress    must outlive this.
    /// @param most_bytes  memory above which is_full() is true.
    WaitingRecords(const Progress& progress, std::size_t most_bytes)
        : progress_(progress), most_bytes_(most_bytes) {}

    void push(WaitingRecord record) {
        const std::lock_guard lock(mutex_);
        bytes_ += record.record.bytes.size();
        records_.push_back(std::move(record));
    }

    /// Removes and returns the oldest record if the journal holds its chunk.
    [[nodiscard]] std::optional<WaitingRecord> pop() {
        const std::lock_guard lock(mutex_);
        if (records_.empty() || !is_journaled()) return std::nullopt;
        return take_oldest();
    }

    /// Puts the record of the last pop() back, because the archive refused it.
    void put_back(WaitingRecord record) {
        const std::lock_guard lock(mutex_);
        bytes_ += record.record.bytes.size();
        records_.push_front(std::move(record));
    }

    /// Drops the oldest record if it cannot be written: the archive refuses it, or the journal has
    /// not taken its chunk.  @return true if it was dropped.
    bool drop_unwritable(bool does_archive_refuse) {
        const std::lock_guard lock(mutex_);
        if (records_.empty() || (!does_archive_refuse && is_journaled())) return false;
        take_oldest();
        return true;
    }

    [[nodiscard]] bool is_full() const {
        const std::lock_guard lock(mutex_);
        return bytes_ > most_bytes_;
    }
    [[nodiscard]] std::size_t count() const {
        const std::lock_guard lock(mutex_);
        return records_.size();
    }

private:
    [[nodiscard]] bool is_journaled() const {
        return records_.front().chunk <= progress_.written();
    }
    WaitingRecord take_oldest() {
        WaitingRecord oldest = std::move(records_.front());
        records_.pop_front();
        bytes_ -= oldest.record.bytes.size();
        return oldest;
    }

    const Progress& progress_;
    std::size_t most_bytes_;
    mutable std::mutex mutex_;
    std::deque<WaitingRecord> records_;
    std::size_t bytes_ = 0;
};

}  // namespace a351::daemon::store
