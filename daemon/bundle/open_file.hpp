#pragma once
/// @file
/// A recorded file that stays readable while it is appended to, renamed or removed.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>

namespace a351::daemon::bundle {

/// Bytes that are read at a time.
inline constexpr std::uint64_t kPiece = std::uint64_t{256} << 10U;

/// A file open for reading.  No link is followed in place of the file: in a folder that others may
/// write, it would show them any file.
class OpenFile {
public:
    /// @throws std::system_error  there is no such regular file, or it cannot be opened.
    explicit OpenFile(const std::filesystem::path& file);
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    ~OpenFile();

    [[nodiscard]] std::uint64_t size() const noexcept { return size_; }  ///< When it was opened.
    [[nodiscard]] std::chrono::sys_seconds time() const noexcept {
        return time_;
    }  ///< Last change.

    /// Returns `count` bytes from `offset` on.
    /// @throws std::system_error  the file is shorter, or the disk fails.
    [[nodiscard]] std::string read(std::uint64_t offset, std::uint64_t count) const;

    /// Waits until the bytes that were written so far are on the disk.
    void sync() const;

    /// Lets the next reads come from the disk, not from memory, as far as the bytes are synced.
    void forget() const noexcept;

private:
    std::filesystem::path path_;
    int descriptor_;
    std::uint64_t size_ = 0;
    std::chrono::sys_seconds time_{};
};

}  // namespace a351::daemon::bundle
