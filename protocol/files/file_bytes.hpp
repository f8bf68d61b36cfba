#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace a351::record {

/// The whole file, or `count` bytes of it from `offset` on.
/// @throws std::system_error  there are not so many, or they cannot be read; with the path.
[[nodiscard]] std::vector<std::byte> read_bytes(const std::filesystem::path& file);
[[nodiscard]] std::vector<std::byte> read_bytes(const std::filesystem::path& file,
                                                std::uint64_t offset, std::uint64_t count);

}  // namespace a351::record
