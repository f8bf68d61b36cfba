#include "protocol/journal/journal_compression.hpp"

#include <zstd.h>

#include <stdexcept>

#include "protocol/files/file_bytes.hpp"

namespace a351::journal {
namespace {

// Default level of zstd; noise compresses little better at higher ones.
constexpr int kLevel = 3;

// A segment is closed when it exceeds 64 MiB; one chunk may exceed it.
constexpr unsigned long long kLargest = (64ULL << 20) + (1ULL << 20);

std::vector<std::byte> compress(std::span<const std::byte> bytes) {
    std::vector<std::byte> packed(ZSTD_compressBound(bytes.size()));
    const std::size_t size =
        ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), kLevel);
    if (ZSTD_isError(size)) throw std::runtime_error(ZSTD_getErrorName(size));
    packed.resize(size);
    return packed;
}

}  // namespace

std::vector<std::byte> decompress_segment(const std::filesystem::path& segment) {
    const auto packed = files::read_bytes(segment);
    const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
    if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN || size > kLargest)
        throw std::runtime_error(segment.string() + ": not a compressed segment");
    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    const std::size_t found =
        ZSTD_decompress(bytes.data(), bytes.size(), packed.data(), packed.size());
    if (ZSTD_isError(found) || found != size)
        throw std::runtime_error(segment.string() + ": damaged compressed segment");
    return bytes;
}

void compress_segment(files::FileLayer& files, const std::filesystem::path& segment) {
    const auto bytes = files::read_bytes(segment);
    const auto packed_name = segment.string() + ".zst";
    const auto partial = packed_name + ".partial";
    if (std::filesystem::exists(partial)) files.remove(partial);
    {
        const auto file = files.open_append(partial);
        file->append(compress(bytes));
        file->sync();
    }
    if (decompress_segment(partial) != bytes)
        throw std::runtime_error(partial + ": differs from the original when read back");
    files.rename(partial, packed_name);
    files.sync_directory(segment.parent_path());
    files.remove(segment);
    files.sync_directory(segment.parent_path());
}

}  // namespace a351::journal
