#pragma once
/// @file
/// Chunks of the journal <-> bytes, shared by writer and reader.  No I/O.
/// Layout: protocol/journal/journal-format.md.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/journal/journal.hpp"

namespace a351::record {

inline constexpr std::string_view kJournalMagic = "A351JRNL";
inline constexpr std::uint32_t kJournalVersion = 1;
inline constexpr std::size_t kPreambleSize = 12;     ///< Magic and version.
inline constexpr std::size_t kChunkHeaderSize = 13;  ///< length, type, sequence, CRC-32C.

/// Code of a chunk on disk: its place among the alternatives of JournalChunk, counted from 1.
enum class ChunkType : std::uint8_t {
    head = 1,
    rx = 2,
    tx = 3,
    clock = 4,
    model = 5,
    event = 6,
    mark = 7,
    oven = 8,
};

static_assert(std::variant_size_v<JournalChunk> == static_cast<std::size_t>(ChunkType::oven));

/// The fields before a payload.
struct ChunkHeader {
    std::uint32_t length = 0;  ///< Bytes of payload.
    std::uint8_t type = 0;
    std::uint32_t sequence = 0;
    std::uint32_t crc = 0;
};

/// Returns magic and version, the first bytes of each segment.
[[nodiscard]] std::vector<std::byte> encode_preamble();
/// Returns true if `bytes` are encode_preamble().
[[nodiscard]] bool is_preamble(std::span<const std::byte> bytes) noexcept;

/// Returns the bytes of a chunk, header and payload.
/// @throws std::invalid_argument  the payload exceeds kMostPayloadBytes; the reads of an RxChunk do
///         not ascend to its last byte; a channel name exceeds 255 characters; an OvenChunk has
///         registers without an answer, or more than 255.
[[nodiscard]] std::vector<std::byte> encode_chunk(const JournalChunk& chunk,
                                                  std::uint32_t sequence);

/// Reads the header of a chunk; nothing is checked.
/// @param bytes  kChunkHeaderSize bytes.
[[nodiscard]] ChunkHeader decode_chunk_header(std::span<const std::byte> bytes) noexcept;

/// Returns the CRC-32C (Castagnoli) over length, type, sequence and payload.
[[nodiscard]] std::uint32_t chunk_crc(const ChunkHeader& header,
                                      std::span<const std::byte> payload);

/// Returns true if `type` is one of ChunkType.
[[nodiscard]] bool is_known(std::uint8_t type) noexcept;

/// Returns the payload of a header: one line of JSON.  Bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string header_to_json(const JournalHeader& header);

/// Reads the payload of a header.  Unknown fields are ignored.
/// @return std::nullopt unless every required field is present, of its type and in range.
[[nodiscard]] std::optional<JournalHeader> parse_header(std::string_view text);

/// Reads the payload of a chunk.
/// @return std::nullopt if the payload is not valid for its type.
[[nodiscard]] std::optional<JournalChunk> decode_payload(ChunkType type,
                                                         std::span<const std::byte> payload);

}  // namespace a351::record
