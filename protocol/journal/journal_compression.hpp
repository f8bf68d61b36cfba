#pragma once
/// @file
/// Compression of closed journal segments, and its inverse.  A compressed segment holds the segment
/// byte for byte, in zstd frames of 512 KiB, so that damage costs one of them at most:
/// protocol/journal/journal-format.md.
///
/// Reader reads both forms, so readers do not need this header.  Compress closed segments
/// only: the writer appends to the newest one, and a program that listed the segments before would
/// look for the old name.

#include <cstddef>
#include <filesystem>
#include <vector>

#include "protocol/files/file_layer.hpp"

namespace a351::journal {

/// Replaces `NAME.a351j` by `NAME.a351j.zst`.  The compressed file is written under a temporary
/// name, synced, read back, compared and renamed; the directory is synced.  Only then the original
/// is removed, and the directory is synced again.
///
/// After any failure at least one of the two files holds the whole segment:
/// compressed_segment_test.cpp lets each file operation fail.  If both exist, segment_files() lists
/// the original; another call replaces the compressed file.  A failure may leave
/// `NAME.a351j.zst.partial`, which the next call removes.
///
/// The content of the segment is not interpreted, so damage in it is kept as it is.  Memory: twice
/// the segment and its compressed form.  Compression is at level 3, zstd's default.
///
/// @param segment  closed segment of at most 65 MiB.  The path must name its directory, because an
///                 empty directory name cannot be synced.
/// @throws std::system_error   a file operation failed.  The original is kept, unless only the last
///                             sync of the directory failed: then it is removed and the compressed
///                             file replaces it.  A power cut may still bring the original back.
/// @throws std::runtime_error  the file read back differs, or zstd failed; the original is kept.
///                             Catch std::system_error first, because it is derived from this type.
void compress_segment(files::FileLayer& files, const std::filesystem::path& segment);

/// Returns the bytes of a compressed segment; those that damage cost are 0.
///
/// A damaged frame is unpacked as far as possible, and the next one is searched for.  The chunks
/// inside are not checked; Reader does that, and reports what is lost.  Sizes are checked before
/// memory is allocated: at most 65 MiB.
///
/// @param segment  file with zstd frames that state their sizes, also a single one; its name does
///                 not matter.
/// @throws std::system_error   it cannot be read.
/// @throws std::runtime_error  it has no zstd frame, or is larger than any segment.
[[nodiscard]] std::vector<std::byte> decompress_segment(const std::filesystem::path& segment);

}  // namespace a351::journal
