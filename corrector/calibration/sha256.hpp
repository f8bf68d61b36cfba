#pragma once

#include <filesystem>
#include <string>

namespace a351::corrector {

/// SHA-256 (FIPS 180-4) of a file's content: 64 lower-case hexadecimal digits.
/// @throws InputError  it cannot be read.
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace a351::corrector
