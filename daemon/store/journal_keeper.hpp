#pragma once
/// @file
/// Care of closed journal segments: compressed after an hour, removed after some days.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>

#include "protocol/files/file_layer.hpp"

namespace a351::daemon::store {

/// Compresses closed segments of the journal and removes old sessions, in a thread of its own.
///
/// The thread uses a processor only when it is otherwise idle.  A fault is counted and tried again
/// at the next interval; segments that could not be compressed remain as they are.
class JournalKeeper {
public:
    struct Options {
        int keep_days = 30;                         ///< Days to keep a session; 0: always.
        std::chrono::seconds compress_after{3600};  ///< Real time since the last write.
        std::chrono::milliseconds interval{60'000};
    };

    struct Status {
        std::uint64_t compressed = 0;
        std::uint64_t removed = 0;
        std::uint64_t faults = 0;
        std::string trouble;  ///< Text of the last fault of the newest tidy(); empty if none.
    };

    JournalKeeper(files::FileLayer& files, std::filesystem::path journal, Options options);
    ~JournalKeeper();

    void start() {
        thread_ = std::thread([this] { run(); });
    }

    /// Declares whether segments are being read by their names.  Meanwhile none is compressed.
    /// Removal continues, because it affects only segments that need not be read.
    void keep_names(bool are_read) noexcept { are_names_read_ = are_read; }

    /// Removes old sessions, then compresses segments that are old enough, except the newest one.
    /// A session is removed if it ended `keep_days` before the newest segment began (by headers
    /// with synchronised clocks) and is completely in the archive.  It is so if a later session has
    /// a MARK.  Its segments are removed from last to first, so that the remaining ones keep their
    /// indices.  Faults are counted.
    void tidy() noexcept;

    [[nodiscard]] Status status() const;

private:
    void run() noexcept;
    void remove_old();
    void compress_closed();
    void note_fault(const std::string& trouble);

    files::FileLayer& files_;
    std::filesystem::path journal_;
    Options options_;
    std::atomic<bool> are_names_read_{false};
    std::string trouble_;  ///< Trouble of the tidy() in progress; used by its thread only.

    mutable std::mutex mutex_;
    std::condition_variable stopped_;
    std::atomic<bool> is_stopping_{false};
    Status status_;
    std::thread thread_;
};

}  // namespace a351::daemon::store
