#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "protocol/files/file_layer.hpp"

namespace a351::record {

/// Replaces `NAME.a351j` by `NAME.a351j.zst`.  The compressed file is written under a temporary
/// name, synced, read back, compared and renamed; the directory is synced.  Only then the original
/// is removed.
/// @throws std::system_error   an operation failed; the original is kept.
/// @throws std::runtime_error  the file read back differs; the original is kept.
void compress_segment(FileLayer& files, const std::filesystem::path& segment);

/// Returns the bytes of a compressed segment.
/// @throws std::system_error   it cannot be read.
/// @throws std::runtime_error  it is not a whole zstd frame, or larger than any segment.
[[nodiscard]] std::vector<std::byte> decompress_segment(const std::filesystem::path& segment);

}  // namespace a351::record
