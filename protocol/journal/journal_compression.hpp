#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "protocol/files/file_layer.hpp"

namespace a351::record {

/// Puts `NAME.a351j.zst` in the place of `NAME.a351j`: compressed under a temporary name, synced, read
/// back, decompressed and compared; renamed, the directory synced; only then is the original removed.
/// @throws std::system_error   the original stands.
/// @throws std::runtime_error  what was read back differs; the original stands.
void compress_segment(FileLayer& files, const std::filesystem::path& segment);

/// The bytes of a compressed segment.
/// @throws std::system_error   it cannot be read.
/// @throws std::runtime_error  it is no whole zstd frame, or larger than any segment.
[[nodiscard]] std::vector<std::byte> decompress_segment(const std::filesystem::path& segment);

}  // namespace a351::record
