#pragma once
/// @file
/// File operations on which durability depends, behind an interface so that a test can make the
/// n-th one fail.  Every failure is a std::system_error whose text names operation and path.

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>

namespace a351::record {

/// File open for appending.  Closing does not sync.
class AppendFile {
public:
    virtual ~AppendFile() = default;
    /// Appends all bytes.  On failure it throws and removes the part already written, if possible.
    virtual void append(std::span<const std::byte> bytes) = 0;
    virtual void sync() = 0;  ///< Calls fdatasync.  A failure is final: do not call it again.
    [[nodiscard]] virtual std::uint64_t size() const = 0;
};

class FileLayer {
public:
    virtual ~FileLayer() = default;
    [[nodiscard]] virtual std::unique_ptr<AppendFile> open_append(
        const std::filesystem::path& file) = 0;  ///< Creates it when absent.
    /// Creates the missing directories; syncs the parent of each.
    virtual void create_directories(const std::filesystem::path& directory) = 0;
    virtual void sync_directory(const std::filesystem::path& directory) = 0;
    virtual void truncate(const std::filesystem::path& file, std::uint64_t size) = 0;  ///< Syncs.
    virtual void rename(const std::filesystem::path& from, const std::filesystem::path& to) = 0;
    virtual void remove(const std::filesystem::path& file) = 0;
    /// Reserves disk blocks for `size` bytes of a file and syncs it; creates it when absent.
    /// @throws std::system_error  operation_not_supported: this file system cannot reserve space.
    virtual void allocate(const std::filesystem::path& file, std::uint64_t size) = 0;
    /// Returns the number of bytes that can still be written; std::nullopt if it is unknown.
    [[nodiscard]] virtual std::optional<std::uint64_t> free_bytes(
        const std::filesystem::path& directory) const = 0;
};

/// Returns the files of the operating system.
[[nodiscard]] FileLayer& posix_files();

/// Returns true if a file name has this shape, in which each # is a digit.
[[nodiscard]] bool has_shape(std::string_view name, std::string_view shape) noexcept;

/// Writes or replaces a small file so that a reader finds either the old or the new content, also
/// after a crash: temporary name, sync, rename.  If it throws, the old file is unchanged.  The
/// directory is not synced.
void write_file_atomically(FileLayer& files, const std::filesystem::path& file,
                           std::span<const std::byte> content);

/// Calls write_file_atomically() and syncs the directory.
void replace_file(FileLayer& files, const std::filesystem::path& file,
                  std::span<const std::byte> content);

/// Returns true if the disk is full or the quota is used up.
[[nodiscard]] inline bool is_disk_full(const std::error_code& error) noexcept {
    return error == std::errc::no_space_on_device ||
           error == std::error_code(EDQUOT, std::generic_category());
}

}  // namespace a351::record
