#pragma once

#include <cstdint>
#include <mutex>
#include <string>

namespace a351::daemon::store {

/// Faults that the threads of the archive report, and their consequences.  Thread-safe.
class ArchiveHealth {
public:
    struct Status {
        std::string trouble;  ///< Text of the last fault; empty if it is over.
        std::uint64_t faults = 0;
        std::uint64_t chunks_lost =
            0;  ///< Chunks that could not be parsed; they are in the journal.
        std::uint64_t records_dropped = 0;  ///< Records dropped because they waited for too long.
        /// False after a failed sync, a lost chunk or a dropped record: nothing is marked as archived
        /// until the next start, which replays the journal from the last mark.
        bool is_marking = true;
    };

    void note_fault(const std::string& trouble) {
        const std::lock_guard lock(mutex_);
        status_.trouble = trouble;
        ++status_.faults;
    }
    void note_success() {
        const std::lock_guard lock(mutex_);
        status_.trouble.clear();
    }
    /// Ends the marks of this run.
    void end_marks() {
        const std::lock_guard lock(mutex_);
        status_.is_marking = false;
    }
    /// Counts a loss, chunks_lost or records_dropped, and ends the marks.
    void note_loss(std::uint64_t Status::*counter) {
        const std::lock_guard lock(mutex_);
        ++(status_.*counter);
        status_.is_marking = false;
    }
    [[nodiscard]] Status status() const {
        const std::lock_guard lock(mutex_);
        return status_;
    }

private:
    mutable std::mutex mutex_;
    Status status_;
};

}  // namespace a351::daemon::store
