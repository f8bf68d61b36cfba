#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace a351::text {

/// Input file of a result: name (without directory), size and CRC-32 (IEEE 802.3).
struct InputFile {
    std::string role;
    std::string name;
    std::uint64_t byte_count = 0;
    std::uint32_t crc32 = 0;
    std::filesystem::path path = {};  ///< Path from which it was read.
};

/// Reads a file and returns its name, size and CRC-32.
/// @throws InputError  it cannot be read.
[[nodiscard]] InputFile describe_input(std::string role, const std::filesystem::path& file);

/// Returns the SHA-256 (FIPS 180-4) of a file's content: 64 lower-case hexadecimal digits.
/// @throws InputError  it cannot be read.
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace a351::text
