#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>

namespace a351::text {

/// Opens a file for reading.  Only regular files are accepted: reading a FIFO could wait forever.
/// @throws InputError  it cannot be read.
[[nodiscard]] std::ifstream open_file(const std::filesystem::path& file);

/// Returns the whole content of a file.
/// @throws InputError  it cannot be read.
[[nodiscard]] std::string read_text_file(const std::filesystem::path& file);

/// Passes the content of a file to `take`, in order, in blocks of at most 64 KiB.  Memory does not
/// grow with the size of the file.
/// @throws InputError  it cannot be read.
void read_file_in_blocks(const std::filesystem::path& file,
                         const std::function<void(std::string_view block)>& take);

}  // namespace a351::text
