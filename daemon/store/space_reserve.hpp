#pragma once
/// @file
/// Use of the disk by journal and archive: the time of their tries, and space reserved for the
/// journal, which is a file that is removed when the disk is full.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>

#include "protocol/files/file_layer.hpp"

namespace a351::daemon::store {

/// The real time that journal and archive use for writing, syncing and trying again.
struct DiskTime {
    std::function<std::chrono::steady_clock::time_point()> now = std::chrono::steady_clock::now;
    /// Time between tries after a file could not be written.
    std::chrono::milliseconds retry_interval{10'000};
};

/// Thread-safe.
class SpaceReserve {
public:
    enum class State {
        present,
        given_up,     ///< The file was removed, or not created yet because space is short.
        unavailable,  ///< The file cannot be created.
    };
    struct Status {
        State state = State::given_up;
        std::string trouble;  ///< Reason why it is unavailable.
        std::uint64_t times_given_up = 0;
        bool is_space_short = false;
    };

    /// Size in bytes: half a day of journal at 50 Hz, 104 MB a day.
    static constexpr std::uint64_t kSize_bytes = std::uint64_t{64} << 20;

    /// Creates the reserve under the same condition as tend(); an existing one is kept.
    /// @param files  must outlive this.
    /// @param file   path; its directory must exist.
    SpaceReserve(files::FileLayer& files, std::filesystem::path file, std::uint64_t size_bytes);

    /// Removes the file.  It stays removed until tend() finds enough free space.
    /// @return false if there is no file to remove.
    /// @throws std::system_error  the file cannot be removed.
    bool give_up();

    /// Checks the free space, and creates a missing reserve if more than twice its size is free.
    void tend();

    /// Returns true if the reserve was given up, or less than its size is free.  The remaining
    /// space is then kept for the journal.
    [[nodiscard]] bool is_space_short() const noexcept;

    [[nodiscard]] Status status() const;

private:
    void make();

    files::FileLayer& files_;
    std::filesystem::path file_;
    std::uint64_t size_bytes_;

    std::mutex disk_mutex_;  ///< Protects the file.
    std::atomic<State> state_{State::given_up};
    std::atomic<bool> is_little_free_{false};
    std::atomic<std::uint64_t> times_given_up_{0};
    mutable std::mutex trouble_mutex_;
    std::string trouble_;
};

[[nodiscard]] const char* to_text(SpaceReserve::State state);

}  // namespace a351::daemon::store
