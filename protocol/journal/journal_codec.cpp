#include "protocol/journal/journal_codec.hpp"

#include <fmt/core.h>

#include <array>
#include <boost/crc.hpp>
#include <cstring>
#include <stdexcept>

#include "protocol/core/invariant.hpp"
#include "protocol/journal/chunk_payload.hpp"
#include "protocol/journal/little_endian.hpp"

namespace a351::journal {

namespace {

// CRC-32C: G. Castagnoli et al., IEEE Trans. Commun. 41(6), 883-892, 1993; reflected and inverted
// as in RFC 3720, appendix B.4.  journal_codec_test.cpp checks the values given there.
using Crc32c = boost::crc_optimal<32, 0x1EDC6F41, 0xFFFFFFFF, 0xFFFFFFFF, true, true>;

constexpr std::size_t kSequenceAt = 5, kCrcAt = 9;  // Places in the header of a chunk, bytes.

std::array<std::byte, kCrcAt> encode_fields_before_crc(const ChunkHeader& header) {
    std::array<std::byte, kCrcAt> out{};
    put_at<std::uint32_t>(out, header.length);
    out[kSequenceAt - 1] = static_cast<std::byte>(header.type);
    put_at<std::uint32_t>(std::span(out).subspan(kSequenceAt), header.sequence);
    return out;
}

}  // namespace

std::vector<std::byte> encode_preamble() {
    std::vector<std::byte> out;
    out.reserve(kPreambleSize);
    put(out, kMagic);
    put<std::uint32_t>(out, kVersion);
    return out;
}

bool is_preamble(std::span<const std::byte> bytes) noexcept {
    if (bytes.size() != kPreambleSize) return false;
    Fields version(bytes.subspan(kMagic.size()));
    return std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) == 0 &&
           version.take<std::uint32_t>() == kVersion;
}

std::vector<std::byte> encode_chunk(const Chunk& chunk, std::uint32_t sequence) {
    std::vector<std::byte> out;
    append_chunk(out, chunk, sequence);
    return out;
}

void append_chunk(std::vector<std::byte>& out, const Chunk& chunk, std::uint32_t sequence) {
    const std::size_t before = out.size();
    try {
        out.resize(before + kChunkHeaderSize);
        append_payload(out, chunk);
        const std::size_t size = out.size() - before - kChunkHeaderSize;
        if (size > kMostPayloadBytes) {
            throw std::invalid_argument(fmt::format(
                "journal chunk: payload of {} bytes; at most {}", size, kMostPayloadBytes));
        }
        const auto encoded = std::span(out).subspan(before);
        put_at<std::uint32_t>(encoded, static_cast<std::uint32_t>(size));
        encoded[kSequenceAt - 1] = static_cast<std::byte>(type_of(chunk));
        renumber_chunk(encoded, sequence);
    } catch (...) {
        out.resize(before);
        throw;
    }
}

void renumber_chunk(std::span<std::byte> chunk, std::uint32_t sequence) {
    put_at<std::uint32_t>(chunk.subspan(kSequenceAt), sequence);
    const ChunkHeader header = decode_chunk_header(chunk);
    require_invariant(chunk.size() == kChunkHeaderSize + header.length,
                      "an encoded chunk has the length in its header");
    put_at<std::uint32_t>(chunk.subspan(kCrcAt),
                          chunk_crc(header, chunk.subspan(kChunkHeaderSize)));
}

ChunkHeader decode_chunk_header(std::span<const std::byte> bytes) noexcept {
    Fields fields(bytes);
    ChunkHeader header;
    header.length = fields.take<std::uint32_t>();
    header.type = fields.take<std::uint8_t>();
    header.sequence = fields.take<std::uint32_t>();
    header.crc = fields.take<std::uint32_t>();
    return header;
}

std::uint32_t chunk_crc(const ChunkHeader& header, std::span<const std::byte> payload) {
    const auto front = encode_fields_before_crc(header);
    Crc32c crc;
    crc.process_bytes(front.data(), front.size());
    crc.process_bytes(payload.data(), payload.size());
    return crc.checksum();
}

}  // namespace a351::journal
