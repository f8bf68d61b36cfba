#pragma once
/// @file
/// The few file operations that durability rests on, behind an interface so that a test can fail
/// the n-th of them.  Every failure is a std::system_error whose text names operation and path.

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <system_error>

namespace a351::record {

/// A file open for appending.  Closing does not sync.
class AppendFile {
public:
    virtual ~AppendFile() = default;
    /// All of them; or throws, and takes back what the disk would still hold of them.
    virtual void append(std::span<const std::byte> bytes) = 0;
    virtual void sync() = 0;  ///< fdatasync.  A failure is final: do not call it again.
    [[nodiscard]] virtual std::uint64_t size() const = 0;
};

class FileLayer {
public:
    virtual ~FileLayer() = default;
    [[nodiscard]] virtual std::unique_ptr<AppendFile> open_append(
        const std::filesystem::path& file) = 0;  ///< Creates it when absent.
    /// Those that are missing, each synced into its parent.
    virtual void create_directories(const std::filesystem::path& directory) = 0;
    virtual void sync_directory(const std::filesystem::path& directory) = 0;
    virtual void truncate(const std::filesystem::path& file, std::uint64_t size) = 0;  ///< Synced.
    virtual void rename(const std::filesystem::path& from, const std::filesystem::path& to) = 0;
    virtual void remove(const std::filesystem::path& file) = 0;
    /// Gives a file blocks of its own for `size` bytes; creates it when absent.  Synced.
    /// @throws std::system_error  operation_not_supported: this file system cannot promise space.
    virtual void allocate(const std::filesystem::path& file, std::uint64_t size) = 0;
    /// What may still be written; std::nullopt when it cannot be told.
    [[nodiscard]] virtual std::optional<std::uint64_t> free_bytes(
        const std::filesystem::path& directory) const = 0;
};

/// The operating system's files.
[[nodiscard]] FileLayer& posix_files();

/// Puts a small file in its place so that a reader, or a crash, sees the old or the new content:
/// temporary name, sync, rename.  When it throws, the old one stands.  The directory is not synced.
void place_file(FileLayer& files, const std::filesystem::path& file,
                std::span<const std::byte> content);

/// The same, and the directory is synced.
void replace_file(FileLayer& files, const std::filesystem::path& file,
                  std::span<const std::byte> content);

/// There is no space, or none within the quota.
[[nodiscard]] inline bool is_disk_full(const std::error_code& error) noexcept {
    return error == std::errc::no_space_on_device ||
           error == std::error_code(EDQUOT, std::generic_category());
}

}  // namespace a351::record
