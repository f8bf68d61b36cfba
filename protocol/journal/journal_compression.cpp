#include "protocol/journal/journal_compression.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>

#include "protocol/files/file_bytes.hpp"

namespace a351::journal {
namespace {

// Default level of zstd; noise compresses little better at higher ones.
constexpr int kLevel = 3;

// A segment is closed when it exceeds 64 MiB; one chunk may exceed it.
constexpr unsigned long long kLargest = (64ULL << 20) + (1ULL << 20);

// Content of a frame, bytes: what damage costs at most, five minutes at 50 Hz.  A simulated hour in
// one frame is smaller by 0.1 % (`zstd -3` of its parts); in frames of 256 KiB it is 2 % larger.
constexpr std::size_t kFrame = std::size_t{512} << 10;

// A skippable frame of RFC 8878 with the size of the segment, before the others: its magic number,
// the size of its content, and the content, a u64.
constexpr std::array<std::uint8_t, 8> kSizeFrame{0x50, 0x2A, 0x4D, 0x18, 8, 0, 0, 0};
constexpr std::size_t kSizeFrameBytes = kSizeFrame.size() + 8;

/// First bytes of a frame with data.
constexpr std::array<std::uint8_t, 4> kFrameMagic{0x28, 0xB5, 0x2F, 0xFD};

bool begins_with(std::span<const std::byte> bytes, std::span<const std::uint8_t> magic) {
    return bytes.size() >= magic.size() &&
           std::equal(magic.begin(), magic.end(), bytes.begin(),
                      [](std::uint8_t a, std::byte b) { return std::byte{a} == b; });
}

std::vector<std::byte> compress(std::span<const std::byte> bytes) {
    std::vector<std::byte> packed;
    for (const std::uint8_t byte : kSizeFrame) packed.push_back(std::byte{byte});
    for (unsigned shift = 0; shift < 64; shift += 8)
        packed.push_back(static_cast<std::byte>(bytes.size() >> shift & 0xFFU));
    for (std::size_t at = 0; at < bytes.size(); at += kFrame) {
        const auto content = bytes.subspan(at, std::min(kFrame, bytes.size() - at));
        const std::size_t end = packed.size();
        packed.resize(end + ZSTD_compressBound(content.size()));
        const std::size_t size = ZSTD_compress(packed.data() + end, packed.size() - end,
                                               content.data(), content.size(), kLevel);
        if (ZSTD_isError(size)) throw std::runtime_error(ZSTD_getErrorName(size));
        packed.resize(end + size);
    }
    return packed;
}

/// Returns the size of the segment that the first frame states; std::nullopt if there is none.
std::optional<std::size_t> stated_size(std::span<const std::byte> packed) {
    if (!begins_with(packed, kSizeFrame) || packed.size() < kSizeFrameBytes) return std::nullopt;
    std::uint64_t size = 0;
    for (std::size_t i = 0; i < 8; ++i)
        size |= std::to_integer<std::uint64_t>(packed[kSizeFrame.size() + i]) << (8 * i);
    if (size > kLargest) return std::nullopt;
    return static_cast<std::size_t>(size);
}

/// Returns the size of the content of a frame; std::nullopt if there is no frame with data here.
std::optional<std::size_t> content_size(std::span<const std::byte> packed) {
    if (!begins_with(packed, kFrameMagic)) return std::nullopt;
    const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
    if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN || size > kLargest)
        return std::nullopt;
    return static_cast<std::size_t>(size);
}

/// Unpacks a frame into `content`, up to its first damage.
/// @return the size of the packed frame if it is whole.
std::optional<std::size_t> unpack(std::span<const std::byte> packed, std::span<std::byte> content) {
    const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> stream(ZSTD_createDCtx(),
                                                                      &ZSTD_freeDCtx);
    if (!stream) throw std::bad_alloc();
    ZSTD_inBuffer in{packed.data(), packed.size(), 0};
    ZSTD_outBuffer out{content.data(), content.size(), 0};
    while (true) {
        const std::size_t before = in.pos + out.pos;
        const std::size_t left = ZSTD_decompressStream(stream.get(), &out, &in);
        if (left == 0 && out.pos == content.size()) return in.pos;
        const bool is_cut_off = in.pos + out.pos == before;
        if (left == 0 || ZSTD_isError(left) || is_cut_off) return std::nullopt;
    }
}

/// Returns the size of a damaged frame, if another one or the end of the file is after it.
std::optional<std::size_t> damaged_size(std::span<const std::byte> packed) {
    const std::size_t size = ZSTD_findFrameCompressedSize(packed.data(), packed.size());
    if (ZSTD_isError(size)) return std::nullopt;
    if (size != packed.size() && !content_size(packed.subspan(size))) return std::nullopt;
    return size;
}

}  // namespace

std::vector<std::byte> decompress_segment(const std::filesystem::path& segment) {
    const auto packed = files::read_bytes(segment);
    const std::optional<std::size_t> stated = stated_size(packed);
    std::vector<std::byte> bytes;
    std::size_t unpacked = 0;  // End of the last frame's content.
    bool has_frame = false;
    bool is_searching = false;  // The bytes of the frame before are in `bytes`, as far as known.
    for (std::size_t at = stated ? kSizeFrameBytes : 0; at < packed.size();) {
        const auto rest = std::span(packed).subspan(at);
        auto size = content_size(rest);
        if (stated && size > kFrame) size.reset();  // A damaged size.
        const std::size_t begin = bytes.size();
        if (size || (stated && !is_searching)) bytes.resize(begin + size.value_or(kFrame));
        if (bytes.size() > kLargest)
            throw std::runtime_error(segment.string() + ": larger than any segment");
        std::optional<std::size_t> length;
        if (size) {
            has_frame = true;
            length = unpack(rest, std::span(bytes).subspan(begin));
            if (!length) length = damaged_size(rest);
            unpacked = bytes.size();
        }
        is_searching = !length;
        at += length.value_or(1);
    }
    if (!has_frame && stated.value_or(1) != 0)
        throw std::runtime_error(segment.string() + ": not a compressed segment");
    // The stated size may be damaged too, so that nothing that was unpacked is cut off.
    if (stated) bytes.resize(std::max(unpacked, *stated));
    return bytes;
}

void compress_segment(files::FileLayer& files, const std::filesystem::path& segment) {
    static_cast<void>(files.open_append(segment));  // Refuses a link in place of a folder.
    const auto bytes = files::read_own_bytes(segment, 0, std::filesystem::file_size(segment));
    const auto packed_name = segment.string() + ".zst";
    const auto partial = packed_name + ".partial";
    if (std::filesystem::exists(std::filesystem::symlink_status(partial))) files.remove(partial);
    {
        const auto file = files.create(partial);
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
