#pragma once
/// @file
/// Chunks of the journal <-> bytes: preamble, header of a chunk and checksum, shared by writer and
/// reader.  The payloads are in chunk_payload.hpp.  No I/O.
/// Layout: protocol/journal/journal-format.md.
///
/// Programs use Writer and Reader; this header is for them, and for tools that check
/// or make single chunks:
///
///     const auto bytes = encode_chunk(chunk, sequence);
///     const ChunkHeader head = decode_chunk_header(std::span(bytes).first(kChunkHeaderSize));
///     const auto payload = std::span(bytes).subspan(kChunkHeaderSize, head.length);
///     if (chunk_crc(head, payload) == head.crc && is_known(head.type))
///         const auto decoded = decode_payload(static_cast<ChunkType>(head.type), payload);
///
/// A reader has to make the checks in this order: length within the file and at most
/// kMostPayloadBytes, checksum, sequence number, type, payload.
///
/// Integers are little-endian on every host.  The same chunk always gives the same bytes, also
/// after it was encoded and decoded (journal_codec_test.cpp).  A change of these bytes requires a
/// new kVersion: journal_reader_test.cpp compares them with a reference file.  All functions
/// may be called from any thread.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "protocol/journal/journal.hpp"

namespace a351::journal {

/// First bytes of each segment, without a terminating zero.
inline constexpr std::string_view kMagic = "A351JRNL";
/// Version of the format.  A reader refuses any other; a further chunk type needs no new version,
/// because readers skip types that they do not know.
inline constexpr std::uint32_t kVersion = 1;
inline constexpr std::size_t kPreambleSize = 12;     ///< Magic and version.
inline constexpr std::size_t kChunkHeaderSize = 13;  ///< length, type, sequence, CRC-32C.

/// The fields before a payload.
struct ChunkHeader {
    std::uint32_t length = 0;  ///< Bytes of payload.
    /// ChunkType, or a number that this version does not know: ask is_known().
    std::uint8_t type = 0;
    /// Number of the chunk in its segment: 0 for the header, then one more for each chunk.
    std::uint32_t sequence = 0;
    /// chunk_crc() as stored.
    std::uint32_t crc = 0;
};

/// Returns magic and version, the first bytes of each segment.
[[nodiscard]] std::vector<std::byte> encode_preamble();
/// Returns true if `bytes` are encode_preamble().
/// @param bytes  the first kPreambleSize bytes of a file; any other number gives false.
[[nodiscard]] bool is_preamble(std::span<const std::byte> bytes) noexcept;

/// Returns the bytes of a chunk, header and payload.
///
/// Only values that the format cannot hold are refused, see append_payload().
///
/// @param sequence  number of the chunk in its segment; 0 for the Header and only for it,
///                  which is not checked.
/// @throws std::invalid_argument  as append_payload(), or the payload exceeds kMostPayloadBytes.
[[nodiscard]] std::vector<std::byte> encode_chunk(const Chunk& chunk, std::uint32_t sequence);

/// Appends the bytes of encode_chunk() to `out`; after an exception `out` is as before.
void append_chunk(std::vector<std::byte>& out, const Chunk& chunk, std::uint32_t sequence);

/// Gives an encoded chunk another sequence number and the checksum for it.
/// @param chunk  header and payload.
void renumber_chunk(std::span<std::byte> chunk, std::uint32_t sequence);

/// Reads the header of a chunk; nothing is checked.
/// @param bytes  kChunkHeaderSize bytes.  Fields that are cut off are 0; further bytes are ignored.
[[nodiscard]] ChunkHeader decode_chunk_header(std::span<const std::byte> bytes) noexcept;

/// Returns the CRC-32C (Castagnoli) over length, type, sequence and payload.
///
/// Polynomial 0x1EDC6F41, reflected, initial value and final exclusive-or 0xFFFFFFFF.  The values
/// of RFC 3720, appendix B.4, are reproduced (journal_codec_test.cpp).
///
/// @param header   its `crc` is not used, so it may be 0 or the stored value.
/// @param payload  its size is not compared with `header.length`.
[[nodiscard]] std::uint32_t chunk_crc(const ChunkHeader& header,
                                      std::span<const std::byte> payload);

}  // namespace a351::journal
