#pragma once
/// @file
/// Reading of input files.  Only regular files and links to them are read, so that no function
/// waits for a pipe or a device.
///
/// Use read_text_file() for settings and tables, read_file_in_blocks() for content of any size, and
/// open_file() for readers that take a stream.  The bytes are not changed: line ends and a
/// byte-order mark remain.  A file that cannot be read is an InputError `file: trouble; allowed:
/// ...`.

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>

namespace a351::text {

/// Opens a file for reading.  Only regular files are accepted: reading a FIFO could wait forever.
/// @return a binary stream at the first byte.  The caller checks bad() for errors of later reads.
/// @throws InputError  it cannot be read.
[[nodiscard]] std::ifstream open_file(const std::filesystem::path& file);

/// Returns the whole content of a file.  An empty file gives "".  Memory is that of the content:
/// there is no limit.
/// @throws InputError  it cannot be read.
[[nodiscard]] std::string read_text_file(const std::filesystem::path& file);

/// Passes the content of a file to `take`, in order, in blocks of at most 64 KiB.  Memory does not
/// grow with the size of the file.
///
/// Blocks end anywhere, also within a line or a UTF-8 letter; the last one can be empty.  If
/// reading fails later, `take` has already had the blocks before.
/// @param take  receives views that are valid during the call only.  What it throws is passed on.
/// @throws InputError  it cannot be read.
void read_file_in_blocks(const std::filesystem::path& file,
                         const std::function<void(std::string_view block)>& take);

}  // namespace a351::text
