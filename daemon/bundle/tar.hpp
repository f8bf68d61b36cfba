#pragma once
/// @file
/// The tar format, as far as a bundle needs it: regular files with short names.
/// IEEE Std 1003.1-2017, pax, "ustar Interchange Format".
///
/// The few lines here are shorter than the calls of a library, and the daemon loads none.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace a351::daemon::bundle {

inline constexpr std::size_t kTarBlock = 512;

/// The values in the header of a file.
struct TarFile {
    std::string name;                 ///< Path with '/', at most 100 bytes.
    std::uint64_t size = 0;           ///< Bytes, less than 8 GiB.
    std::chrono::sys_seconds time{};  ///< Last change, not before 1970.

    bool operator==(const TarFile&) const = default;
};

/// Returns the block before the content of a file.  Owner is root, and everybody may read the file.
/// @throws std::invalid_argument  name or size is too large.
[[nodiscard]] std::string tar_header(const TarFile& file);

/// Returns the number of zeros after `size` bytes of content.
[[nodiscard]] constexpr std::size_t tar_padding(std::uint64_t size) noexcept {
    return static_cast<std::size_t>((kTarBlock - size % kTarBlock) % kTarBlock);
}

/// Number of zeros at the end of a tar file.
inline constexpr std::size_t kTarEnd = 2 * kTarBlock;

/// Reads the block before the content of a file.
/// @param block  kTarBlock bytes.
/// @return std::nullopt if it is not the header of a regular file as tar_header() makes it.
[[nodiscard]] std::optional<TarFile> parse_tar_header(std::string_view block);

}  // namespace a351::daemon::bundle
