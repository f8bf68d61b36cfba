#pragma once
/// @file
/// File operations on which durability depends, behind an interface so that a test can make the
/// n-th one fail.  Every failure is a std::system_error whose text names operation and path.
///
/// Use it for records that must survive a power failure.  For results that can be computed again
/// use protocol/text, which does not sync.
///
/// Appended bytes survive after a sync of the file.  A created, renamed or removed name survives
/// after a sync of its directory.
///
///     const auto file = files.open_append(directory / "log");
///     files.sync_directory(directory);  // the name
///     file->append(bytes);
///     file->sync();                     // the content
///
/// Programs use posix_files(); tests use a FileLayer of their own
/// (tests/unit/files/failing_files.hpp).

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>

namespace a351::files {

/// File open for appending.  Closing does not sync.
///
/// The destructor closes the file and reports no error, because only synced data are guaranteed.
/// One thread at a time may use an object, and only one object at a time may write a file.
class AppendFile {
public:
    virtual ~AppendFile() = default;
    /// Appends all bytes.  On failure it throws and removes the part already written, if possible.
    /// Readers must therefore accept an incomplete end.  An empty span appends nothing.
    virtual void append(std::span<const std::byte> bytes) = 0;
    virtual void sync() = 0;  ///< Calls fdatasync.  A failure is final: do not call it again.
    /// Returns the size in bytes: that at opening plus all that was appended by this object.  An
    /// incomplete end that could not be removed counts.
    [[nodiscard]] virtual std::uint64_t size() const = 0;
};

/// Work of a disk.
struct DiskWork {
    /// Bytes of the blocks of 4096 bytes that syncs wrote.  A block that is synced when it is
    /// partly filled, and again later, counts each time, as it does on the disk.  What the file
    /// system writes for itself does not count.
    std::uint64_t bytes = 0;
    std::uint64_t syncs = 0;  ///< Syncs of files and directories.
};

/// File operations of a recorder.
///
/// All members except free_bytes() and work() throw std::system_error.  Its code is that of the operating
/// system; is_disk_full() separates a full disk from other faults.
class FileLayer {
public:
    virtual ~FileLayer() = default;
    /// Opens a file for appending; its directory must exist.  Existing content is kept.  The name
    /// of a new file is durable after sync_directory().
    [[nodiscard]] virtual std::unique_ptr<AppendFile> open_append(
        const std::filesystem::path& file) = 0;  ///< Creates it when absent.
    /// Creates a file and opens it for appending.  An existing name, also that of a link, is an
    /// error.  A layer for tests may open an existing file.
    [[nodiscard]] virtual std::unique_ptr<AppendFile> create(const std::filesystem::path& file) {
        return open_append(file);
    }
    /// Creates the missing directories; syncs the parent of each.
    virtual void create_directories(const std::filesystem::path& directory) = 0;
    /// Makes the names in a directory durable, after a file in it was created, renamed or removed.
    virtual void sync_directory(const std::filesystem::path& directory) = 0;
    /// Sets the size of an existing file.  A larger size appends zeros.
    virtual void truncate(const std::filesystem::path& file, std::uint64_t size) = 0;  ///< Syncs.
    /// Renames a file within one file system; an existing `to` is replaced in one step.  Does not
    /// sync the directory.
    virtual void rename(const std::filesystem::path& from, const std::filesystem::path& to) = 0;
    /// Removes an existing file, not a directory.  Does not sync the directory.
    virtual void remove(const std::filesystem::path& file) = 0;
    /// Reserves disk blocks for `size` bytes of a file and syncs it; creates it when absent.  The
    /// file becomes at least that large, never smaller; its content is kept.
    /// @param size  bytes, > 0.
    /// @throws std::system_error  operation_not_supported: this file system cannot reserve space.
    virtual void allocate(const std::filesystem::path& file, std::uint64_t size) = 0;
    /// Returns the number of bytes that can still be written; std::nullopt if it is unknown.
    /// Space that only root may use does not count.  Throws nothing.
    [[nodiscard]] virtual std::optional<std::uint64_t> free_bytes(
        const std::filesystem::path& directory) const = 0;
    /// Returns the work since the layer was made.  A layer for tests need not count.
    [[nodiscard]] virtual DiskWork work() const { return {}; }
};

/// Returns the files of the operating system.  The object lives as long as the program.  Any number
/// of threads may use it.  New files have mode 0644 and new directories 0755,
/// less the umask.
[[nodiscard]] FileLayer& posix_files();

/// Returns files like posix_files() that follow no link in place of a folder below `root`.  Others
/// may have write access to a data root; a link would let them choose where root writes.  The root
/// itself may be a link.  Names in a path above the root, and names read by other means, are
/// followed.
[[nodiscard]] std::unique_ptr<FileLayer> files_below(std::filesystem::path root);

/// Returns true if a file name has this shape, in which each # is a digit.  All other characters
/// and the length must be equal: `2026-03.jsonl` has the shape `####-##.jsonl`.
[[nodiscard]] bool has_shape(std::string_view name, std::string_view shape) noexcept;

/// Writes or replaces a small file so that a reader finds either the old or the new content, also
/// after a crash: temporary name, sync, rename.  If it throws, the old file is unchanged.  The
/// directory is not synced.
///
/// An error or a crash may leave the temporary file; the next call removes it.  One thread and one
/// process at a time may write a file.
/// @param file       name in an existing directory.
/// @param content    all bytes; may be empty.
/// @param temporary  temporary name, on the same file system; default: `file` with `.tmp` at its
///                   end.
void write_file_atomically(FileLayer& files, const std::filesystem::path& file,
                           std::span<const std::byte> content,
                           std::filesystem::path temporary = {});

/// Calls write_file_atomically() and syncs the directory.  After it returns, the new content
/// survives a power failure.  If the sync of the directory fails it throws, although readers
/// already find the new content.  file_layer_test.cpp fails each operation in turn.
void replace_file(FileLayer& files, const std::filesystem::path& file,
                  std::span<const std::byte> content);

/// Returns true if the disk is full or the quota is used up.  The operation can then succeed later,
/// after files were removed.
/// @param error  code() of the std::system_error.
[[nodiscard]] inline bool is_disk_full(const std::error_code& error) noexcept {
    return error == std::errc::no_space_on_device ||
           error == std::error_code(EDQUOT, std::generic_category());
}

}  // namespace a351::files
