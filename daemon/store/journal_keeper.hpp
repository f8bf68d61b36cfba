#pragma once
/// @file
/// What happens to closed segments of the journal: compressed after an hour, removed after some days.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>

#include "protocol/files/file_layer.hpp"

namespace a351::daemon {

/// Runs in a thread of its own that takes a processor only when nobody else wants it.
class JournalKeeper {
public:
    struct Options {
        int keep_days = 30;                         ///< 0: for ever.
        std::chrono::seconds compress_after{3600};  ///< Since the last write, in real time.
        std::chrono::milliseconds interval{60'000};
    };

    struct Status {
        std::uint64_t compressed = 0;
        std::uint64_t removed = 0;
        std::uint64_t faults = 0;
        std::string trouble;  ///< The last fault.
    };

    JournalKeeper(record::FileLayer& files, std::filesystem::path journal, Options options);
    ~JournalKeeper();

    void start();

    /// While someone reads segments by their names none is compressed; removed is none that matters.
    void keep_names(bool are_read) noexcept { are_names_read_ = are_read; }

    /// Removes sessions that ended `keep_days` before the newest segment began, by headers whose
    /// clocks were synchronised, and that are wholly in the archive: a later session has a MARK.  A
    /// session goes from its last segment to its first, so that what is left of it keeps its indices.
    /// Then compresses what is old enough, but never the newest segment.  Faults are counted.
    void tidy() noexcept;

    [[nodiscard]] Status status() const;

private:
    void run() noexcept;
    void remove_old();
    void compress_closed();
    void note_fault(const std::string& trouble);
    [[nodiscard]] bool is_stopping() const;

    record::FileLayer& files_;
    std::filesystem::path journal_;
    Options options_;
    std::atomic<bool> are_names_read_{false};

    mutable std::mutex mutex_;
    std::condition_variable stopped_;
    bool is_stopping_ = false;
    Status status_;
    std::thread thread_;
};

}  // namespace a351::daemon
