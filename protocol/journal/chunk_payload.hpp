#pragma once
/// @file
/// Payloads of the journal's chunks <-> bytes, by type.  No I/O.
/// Layout: protocol/journal/journal-format.md, "Types".
///
/// journal_codec.hpp puts header and checksum around a payload; programs use Writer and Reader.
///
///     if (!is_known(header.type)) return;  // of a later version: skip it
///     const auto chunk = decode_payload(static_cast<ChunkType>(header.type), payload);
///     if (!chunk) return;                  // damaged
///
/// The same chunk always gives the same bytes, also after it was encoded and decoded
/// (journal_codec_test.cpp).  All functions may be called from any thread.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <variant>
#include <vector>

#include "protocol/journal/journal.hpp"

namespace a351::journal {

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

/// Returns the code of a chunk.
[[nodiscard]] ChunkType type_of(const Chunk& chunk);

/// Returns true if `type` is one of ChunkType.  A chunk of another type, with a good checksum, was
/// written by a later version: skip it.
[[nodiscard]] bool is_known(std::uint8_t type) noexcept;

/// Appends the payload of a chunk.
///
/// Only values that the format cannot hold are refused.  Times, indices, station codes and the oven
/// interval are not checked here: a chunk with values out of range is encoded, and decode_payload()
/// refuses it.  SampleTime::is_host_synchronised of a ModelChunk is not stored.
///
/// @throws std::invalid_argument  the reads of an RxChunk do not ascend to its last byte; a channel
///         name exceeds 255 characters; an OvenChunk has registers without an answer, an answer
///         without registers, or more than 255 registers.  Part of it may have been appended.
void append_payload(std::vector<std::byte>& out, const Chunk& chunk);

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
