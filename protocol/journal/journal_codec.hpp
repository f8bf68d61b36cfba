#pragma once
/// @file
/// Chunks of the journal <-> bytes, shared by writer and reader.  No I/O.
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
#include <optional>
#include <span>
#include <string>
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

/// Code of a chunk on disk: its place among the alternatives of Chunk, counted from 1.  A poll of the
/// outer oven has a code of its own, so that readers of earlier versions skip it.
/// The codes are part of the format: never change one, add new ones at the end.
enum class ChunkType : std::uint8_t {
    head = 1,
    rx = 2,
    tx = 3,
    clock = 4,
    model = 5,
    event = 6,
    mark = 7,
    oven = 8,
    outer_oven = 9,
};

/// True if `Kind` is the alternative of Chunk with this code.
template <ChunkType kType, class Kind>
inline constexpr bool kIsCoded =
    std::is_same_v<std::variant_alternative_t<static_cast<std::size_t>(kType) - 1, Chunk>, Kind>;
static_assert(std::variant_size_v<Chunk> == static_cast<std::size_t>(ChunkType::oven));
static_assert(kIsCoded<ChunkType::head, Header> && kIsCoded<ChunkType::rx, RxChunk> &&
              kIsCoded<ChunkType::tx, TxChunk> &&
              kIsCoded<ChunkType::clock, timing::ClockReading> &&
              kIsCoded<ChunkType::model, ModelChunk> && kIsCoded<ChunkType::event, EventChunk> &&
              kIsCoded<ChunkType::mark, MarkChunk> && kIsCoded<ChunkType::oven, OvenChunk>);

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
/// Only what the format cannot hold is refused.  Times, indices, station codes and the oven
/// interval are not checked here: a chunk with values out of range is encoded, and decode_payload()
/// refuses it.  SampleTime::is_host_synchronised of a ModelChunk is not stored.
///
/// @param sequence  number of the chunk in its segment; 0 for the Header and only for it,
///                  which is not checked.
/// @throws std::invalid_argument  the payload exceeds kMostPayloadBytes; the reads of an RxChunk do
///         not ascend to its last byte; a channel name exceeds 255 characters; an OvenChunk has
///         registers without an answer, an answer without registers, or more than 255 registers.
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

/// Returns true if `type` is one of ChunkType.  A chunk of another type, with a good checksum, was
/// written by a later version: skip it.
[[nodiscard]] bool is_known(std::uint8_t type) noexcept;

/// Returns the payload of a header: one line of JSON.  Bytes that are not UTF-8 become U+FFFD.
///
/// The order of the keys is fixed.  Members with their default are left out if the format permits
/// it: device_assumed, port, declared_rate_hz, oven_interval_s, outer_oven_interval_s, record_age_s, leap
/// and repeats.  A declared rate
/// must be finite, because parse_header() refuses the `null` that JSON has instead.
[[nodiscard]] std::string header_to_json(const Header& header);

/// Reads the payload of a header.  Unknown fields are ignored.
///
/// These are compared with their limits: session, station codes, clock, leap, both oven intervals,
/// record_age_s.
/// Profile, filter, rates and burst_ctrl are not: find them in the profile before use.  A number
/// that does not fit the type of its member is converted, not refused.
///
/// @param text  one JSON object in UTF-8; white space around it is permitted.
/// @return std::nullopt unless the text is an object, every required field is present and
///         convertible to its member, and those above are within their limits.
[[nodiscard]] std::optional<Header> parse_header(std::string_view text);

/// Reads the payload of a chunk.
///
/// It never throws because of the content.  A number of reads that the payload cannot hold is
/// refused before memory is allocated for it.  The checksum is not computed: compare chunk_crc()
/// first.
///
/// The limits are those of journal.hpp: instants, spans, clock errors and indices.  The text of an
/// EventChunk is not parsed.
///
/// @param payload  exactly the payload.  Types of fixed size refuse a longer one; RX, TX, EVENT and
///                 MARK extend to its end.
/// @return std::nullopt if the payload is not valid for its type.
[[nodiscard]] std::optional<Chunk> decode_payload(ChunkType type,
                                                  std::span<const std::byte> payload);

}  // namespace a351::journal
