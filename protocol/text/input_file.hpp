#pragma once
/// @file
/// Identity of the files from which a result was computed: size and checksum.
///
/// A result lists its inputs, so that a reader can check later that a file is the same.  Use the
/// CRC-32 against mistakes, and the SHA-256 where one file must be identified among all others.
///
/// Each function reads the file once more, in blocks of fixed size.  A file that changed since the
/// program read it gives the checksum of its new content.  Programs that use this header link
/// a351_input_file, which is a library of its own because it needs Nettle.

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace a351::text {

/// Input file of a result: name (without directory), size and CRC-32 (IEEE 802.3).
struct InputFile {
    /// Use of the file in the result, for example "survey", "calibration" or "tide".
    std::string role;
    std::string name;
    /// Size of the content, bytes.
    std::uint64_t byte_count = 0;
    /// CRC-32 of the content, as zlib and gzip compute it; 0 for an empty file.
    std::uint32_t crc32 = 0;
    std::filesystem::path path = {};  ///< Path from which it was read.
};

/// Writes an input for result.json: role, name, byte_count and crc32.  With it nlohmann/json converts
/// InputFile, and a vector of it, by itself.
void to_json(nlohmann::ordered_json& json, const InputFile& input);

/// Reads a file and returns its name, size and CRC-32.
/// @param role  text for InputFile::role; it is not interpreted.
/// @param file  a regular file, or a link to one.
/// @throws InputError  it cannot be read.
[[nodiscard]] InputFile describe_input(std::string role, const std::filesystem::path& file);

/// Returns the SHA-256 of a file's content, as Sha256::hex() does.
/// @param file  a regular file, or a link to one.
/// @throws InputError  it cannot be read.
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace a351::text
