#pragma once
/// @file
/// What happens to closed segments of the journal: compressed after an hour, removed after some days.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "protocol/record/file_layer.hpp"

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

    /// @param covered_below  segments with lower numbers are in the archive, by a MARK that is synced.
    JournalKeeper(record::FileLayer& files, std::filesystem::path journal, Options options,
                  std::function<std::uint64_t()> covered_below);
    ~JournalKeeper();

    void start();

    /// Removes what is covered and `keep_days` older than the newest segment, by the clocks in their
    /// headers, both synchronised; then compresses what is old enough.  Never the newest segment.
    /// @throws std::system_error, std::runtime_error  at the first fault; what was done stays.
    void tidy();

    [[nodiscard]] Status status() const;

private:
    void run() noexcept;
    void remove_old();
    void compress_closed();
    [[nodiscard]] bool is_stopping() const;

    record::FileLayer& files_;
    std::filesystem::path journal_;
    Options options_;
    std::function<std::uint64_t()> covered_below_;

    mutable std::mutex mutex_;
    std::condition_variable stopped_;
    bool is_stopping_ = false;
    Status status_;
    std::thread thread_;
};

}  // namespace a351::daemon
