#pragma once
/// @file
/// Space reserved for the journal: a file that is removed when the disk is full.

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>

#include "daemon/store/disk_policy.hpp"
#include "protocol/files/file_layer.hpp"

namespace a351::daemon::store {

/// Thread-safe.
class SpaceReserve {
public:
    using State = ReserveState;
    struct Status {
        State state = State::given_up;
        std::string trouble;  ///< Reason why it is unavailable.
        std::uint64_t times_given_up = 0;
        bool is_space_short = false;
    };

    /// Creates the reserve under the same condition as tend(); an existing one is kept.
    /// @param files  must outlive this.
    /// @param file   path; its directory must exist.
    SpaceReserve(files::FileLayer& files, std::filesystem::path file, std::uint64_t size_bytes);

    /// Runs an operation of journal, event log or start.  If the disk is full, gives up the reserve
    /// and runs it once more.
    template <typename Operation>
    auto use_for(const Operation& operation) {
        try {
            return operation();
        } catch (const std::system_error& error) {
            if (!files::is_disk_full(error.code()) || !give_up()) throw;
        }
        return operation();
    }

    /// Removes the file.  It stays removed until tend() finds enough free space.
    /// @return false if there is no file to remove.
    /// @throws std::system_error  the file cannot be removed.
    bool give_up();

    /// Checks the free space, and creates a missing reserve if there is enough.
    void tend();

    [[nodiscard]] bool is_space_short() const;

    [[nodiscard]] Status status() const;

private:
    void make();
    void set(State state, const std::string& trouble = {});

    files::FileLayer& files_;
    std::filesystem::path file_;
    std::uint64_t size_bytes_;

    std::mutex disk_mutex_;     ///< Protects the file.
    mutable std::mutex mutex_;  ///< Mutex of all that follows; not locked for disk access.
    std::optional<std::uint64_t> free_bytes_;
    Status status_;
};

[[nodiscard]] const char* to_text(SpaceReserve::State state);

}  // namespace a351::daemon::store
