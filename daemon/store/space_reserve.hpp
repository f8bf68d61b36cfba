#pragma once
/// @file
/// Space set aside for the journal: a file whose blocks are given back when the disk is full.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>

#include "protocol/files/file_layer.hpp"

namespace a351::daemon {

/// For any number of threads.
class SpaceReserve {
public:
    enum class State {
        present,
        given_up,     ///< Or not yet there for want of space.
        unavailable,  ///< The file cannot be made.
    };
    struct Status {
        State state = State::given_up;
        std::string trouble;  ///< Why it is unavailable.
        std::uint64_t times_given_up = 0;
        bool is_space_short = false;
    };

    /// Half a day of journal at 50 Hz, 104 MB a day.
    static constexpr std::uint64_t kSize_bytes = std::uint64_t{64} << 20;

    /// Makes the reserve, as tend() does; one that is there is kept.
    /// @param files  must outlive this.
    /// @param file   its directory exists.
    SpaceReserve(record::FileLayer& files, std::filesystem::path file, std::uint64_t size_bytes);

    /// Gives the space back, for good until tend() finds more.
    /// @return false when there is nothing to give.
    /// @throws std::system_error  the file cannot be removed.
    bool give_up();

    /// Looks at the free space; with more than twice the reserve a missing one is made again.
    void tend();

    /// The reserve was given up, or what is free is less than it: what is left is the journal's.
    [[nodiscard]] bool is_space_short() const noexcept;

    [[nodiscard]] Status status() const;

private:
    void make();

    record::FileLayer& files_;
    std::filesystem::path file_;
    std::uint64_t size_bytes_;

    std::mutex disk_mutex_;  ///< Of the file.
    std::atomic<State> state_{State::given_up};
    std::atomic<bool> is_little_free_{false};
    std::atomic<std::uint64_t> times_given_up_{0};
    mutable std::mutex trouble_mutex_;
    std::string trouble_;
};

[[nodiscard]] const char* to_text(SpaceReserve::State state);

}  // namespace a351::daemon
