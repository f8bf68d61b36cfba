#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>

namespace a351::text {

/// A file to be read.  Nothing but a regular file: a FIFO would be waited for without end.
/// @throws InputError  it cannot be read.
[[nodiscard]] std::ifstream open_file(const std::filesystem::path& file);

/// The whole content of a file.
/// @throws InputError  it cannot be read.
[[nodiscard]] std::string read_text_file(const std::filesystem::path& file);

/// Gives the content of a file of any size piece by piece, in order: memory for one piece.
/// @throws InputError  it cannot be read.
void read_file_in_blocks(const std::filesystem::path& file,
                         const std::function<void(std::string_view block)>& take);

}  // namespace a351::text
