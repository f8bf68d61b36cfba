#pragma once
/// @file
/// Reading of recorded files as bytes, for code that decodes them.
///
/// Use it for journals, archives and state.  Settings and tables of a person are read by
/// protocol/text, whose errors are InputError.  Reading needs no FileLayer, so a fault that a test
/// puts into a FileLayer does not affect it.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace a351::files {

/// Reads a whole file, or `count` bytes from `offset` on.
///
/// All bytes are in memory at once.  Bytes that another process appends after the call are not
/// included.
/// @param offset  first byte, counted from 0.
/// @param count   exact number of bytes; 0 gives none, but the file must open.
/// @return as many bytes as requested, never fewer; none for an empty file.
/// @throws std::system_error  the file is shorter or cannot be read; names the path.
[[nodiscard]] std::vector<std::byte> read_bytes(const std::filesystem::path& file);
[[nodiscard]] std::vector<std::byte> read_bytes(const std::filesystem::path& file,
                                                std::uint64_t offset, std::uint64_t count);

/// Reads bytes like read_bytes(), but not through a link in place of the file.  Use it for bytes
/// that are copied: in a folder that others may write, a link would show them any file.
/// @throws std::system_error  `file` is a link.
[[nodiscard]] std::vector<std::byte> read_own_bytes(const std::filesystem::path& file,
                                                    std::uint64_t offset, std::uint64_t count);

}  // namespace a351::files
