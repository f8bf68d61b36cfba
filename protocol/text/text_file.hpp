#pragma once

#include <filesystem>
#include <string>

namespace a351::text {

/// The whole content of a file.
/// @throws InputError  it cannot be read.
[[nodiscard]] std::string read_text_file(const std::filesystem::path& file);

}  // namespace a351::text
