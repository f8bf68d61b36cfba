#pragma once
/// @file
/// A disk that fails, hangs, is full, and loses at a power cut what was not synced.

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "sim/noise/random.hpp"
#include "tests/simulation/host.hpp"
#include "tests/simulation/schedule.hpp"
#include "tests/unit/files/forwarding_files.hpp"

namespace a351::simulation {

/// Files in a real folder, which nothing syncs to the medium.  What POSIX leaves open is drawn:
/// after a power cut a directory has the first of its changes since its last sync, any number of
/// them; a file has its synced bytes, and of the others a first part in which pages can be zero.
class SimulatedDisk final : public test::ForwardingFiles {
public:
    enum class Trouble { none, fails, is_full, hangs };
    /// The files that a trouble affects.
    enum class Part { all, journal, archive };

    SimulatedDisk(std::uint64_t seed, Schedule& schedule, Host& host, std::filesystem::path root);

    /// Begins a trouble, which lasts until `end`.
    void trouble(Trouble kind, Part part, Nanoseconds end);
    [[nodiscard]] bool is_in_trouble() const { return schedule_.now() < trouble_end_; }
    /// Returns when the last trouble ended or will end.
    [[nodiscard]] Nanoseconds trouble_end() const noexcept { return trouble_end_; }

    /// Leaves the folder as a power cut at this moment does.
    void cut_power();

    /// Returns true if a sync of a file failed since forget_holes(), so that pages can be zero.
    [[nodiscard]] bool has_holes(const std::filesystem::path& file) const {
        return files_with_holes_.contains(file);
    }
    void forget_holes() { files_with_holes_.clear(); }

    std::unique_ptr<files::AppendFile> open_append(const std::filesystem::path& file) override;
    void create_directories(const std::filesystem::path& directory) override;
    void sync_directory(const std::filesystem::path& directory) override;
    void truncate(const std::filesystem::path& file, std::uint64_t size) override;
    void rename(const std::filesystem::path& from, const std::filesystem::path& to) override;
    void remove(const std::filesystem::path& file) override;
    void allocate(const std::filesystem::path& file, std::uint64_t size) override;
    [[nodiscard]] std::optional<std::uint64_t> free_bytes(
        const std::filesystem::path& directory) const override;

private:
    class File;
    enum class Operation { append, sync, takes_space, other };

    /// A change of a directory that no sync has made durable.
    struct Change {
        std::filesystem::path from;  ///< Empty: the name is new.
        std::filesystem::path to;    ///< Empty: the name was removed.
        std::filesystem::path kept;  ///< Content that `to` or a removed `from` had; may be empty.
    };

    [[nodiscard]] bool is_affected(const std::filesystem::path& file) const;
    void operate(Operation operation, const std::filesystem::path& file);
    std::filesystem::path keep(const std::filesystem::path& file);
    void undo(const Change& change);
    void zero_pages(const std::filesystem::path& file, std::uint64_t synced);
    void touch(const std::filesystem::path& file) const;

    Schedule& schedule_;
    Host& host_;
    std::filesystem::path root_, kept_;
    sim::noise::RandomStream random_;
    Trouble trouble_ = Trouble::none;
    Part part_ = Part::all;
    Nanoseconds trouble_end_{0};
    std::map<std::filesystem::path, std::uint64_t> synced_sizes_;
    std::map<std::filesystem::path, std::vector<Change>>
        changes_;  ///< Changes of each directory, in order.
    std::set<std::filesystem::path> files_with_holes_;
    int kept_count_ = 0;
};

}  // namespace a351::simulation
