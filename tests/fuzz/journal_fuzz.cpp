/// @file
/// Journal segments.  The input is read once as it is, and once with corrected lengths, numbers and
/// checksums, so that the payloads reach the archiver and the re-timing.

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "protocol/archive/archiver.hpp"
#include "protocol/archive/retime.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/journal/journal_codec.hpp"
#include "protocol/journal/journal_reader.hpp"
#include "tests/fuzz/fuzz_file.hpp"

namespace {

using namespace a351;
using namespace a351::archive;
using namespace a351::journal;
using fuzz::require;

class Sink : public archive::Sink {
public:
    void record(const std::string&, const PackedRecord& packed, std::int64_t) override {
        require(decode_record(packed.bytes).has_value());
    }
};

void put(std::vector<std::byte>& out, std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8)
        out.push_back(static_cast<std::byte>(value >> shift));
}

/// Returns the input with corrected lengths, numbers and checksums of its chunks.
std::vector<std::byte> put_right(std::span<const std::byte> input) {
    std::vector<std::byte> out = encode_preamble();
    input = input.subspan(std::min(input.size(), kPreambleSize));
    for (std::uint32_t sequence = 0; input.size() >= kChunkHeaderSize; ++sequence) {
        ChunkHeader header = decode_chunk_header(input.first(kChunkHeaderSize));
        input = input.subspan(kChunkHeaderSize);
        header.length = static_cast<std::uint32_t>(
            std::min<std::size_t>({header.length, input.size(), kMostPayloadBytes}));
        header.sequence = sequence;
        const auto payload = input.first(header.length);
        input = input.subspan(header.length);
        put(out, header.length);
        out.push_back(static_cast<std::byte>(header.type));
        put(out, sequence);
        put(out, chunk_crc(header, payload));
        out.insert(out.end(), payload.begin(), payload.end());
    }
    return out;
}

std::vector<journal::Chunk> chunks(std::string_view bytes) {
    journal::Reader reader(fuzz::file_of(bytes, "00000001_20260301T130000Z.a351j"));
    std::vector<journal::Chunk> chunks;
    while (auto chunk = reader.next()) chunks.push_back(std::move(*chunk));
    return chunks;
}

/// Archives the chunks and returns true if the archiver accepted them all.
bool archived(const std::vector<journal::Chunk>& chunks, Retiming& retiming) {
    Sink sink;
    Archiver archiver(sink, &retiming);
    try {
        for (const journal::Chunk& chunk : chunks) archiver.take(chunk);
    } catch (const InputError&) {
        return false;
    }
    archiver.close_records();
    return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    (void)chunks(fuzz::text_of(data, size));
    const auto right = put_right(std::as_bytes(std::span(data, size)));
    const auto taken = chunks({reinterpret_cast<const char*>(right.data()), right.size()});
    Retiming retiming;
    if (!archived(taken, retiming)) return 0;
    retiming.begin_second_pass();
    require(archived(taken, retiming));
    return 0;
}
