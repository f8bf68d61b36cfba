#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace a351::record {

/// Reads a whole file, or `count` bytes from `offset` on.
/// @throws std::system_error  the file is shorter or cannot be read; names the path.
[[nodiscard]] std::vector<std::byte> read_bytes(const std::filesystem::path& file);
[[nodiscard]] std::vector<std::byte> read_bytes(const std::filesystem::path& file,
                                                std::uint64_t offset, std::uint64_t count);

}  // namespace a351::record
