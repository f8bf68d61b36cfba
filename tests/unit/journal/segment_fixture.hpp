#pragma once
/// @file
/// A journal segment with one chunk of each kind, and its file.

#include <optional>
#include <vector>

#include "protocol/journal/journal_codec.hpp"
#include "protocol/journal/journal_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/journal/journal_samples.hpp"

namespace a351::journal {

using Bytes = std::vector<std::byte>;

inline void append(Bytes& bytes, const Bytes& more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
}

/// Returns a segment of the given chunks, numbered from 0.
/// @param ends  receives the end of the preamble and of each chunk
inline Bytes segment_of(const std::vector<Chunk>& chunks,
                        std::vector<std::size_t>* ends = nullptr) {
    auto bytes = encode_preamble();
    if (ends != nullptr) *ends = {bytes.size()};
    std::uint32_t sequence = 0;
    for (const auto& chunk : chunks) {
        append(bytes, encode_chunk(chunk, sequence++));
        if (ends != nullptr) ends->push_back(bytes.size());
    }
    return bytes;
}

/// Returns the kinds of chunks, as indices of the variant.
inline std::vector<std::size_t> kinds_of(const std::vector<Chunk>& chunks) {
    std::vector<std::size_t> kinds;
    for (const auto& chunk : chunks) kinds.push_back(chunk.index());
    return kinds;
}

struct Reading {
    std::size_t chunk_count = 0;
    std::optional<Damage> damage;  ///< The newest.
    std::vector<std::uint32_t> sequences;
    std::vector<std::size_t> kinds;
};

inline Reading read_all(const std::filesystem::path& file) {
    Reader reader(file);
    Reading reading;
    while (const auto chunk = reader.next()) {
        ++reading.chunk_count;
        reading.sequences.push_back(reader.sequence());
        reading.kinds.push_back(chunk->index());
    }
    CHECK_FALSE(reader.next());
    if (!reader.damage().empty()) reading.damage = reader.damage().back();
    return reading;
}

class Fixture {
public:
    Reading read(const Bytes& bytes) {
        test::write_bytes(file_, bytes);
        return read_all(file_);
    }

protected:
    test::TemporaryDirectory directory_;
    std::filesystem::path file_ = directory_.path() / "00000001_20260301T130000Z.a351j";
    std::vector<std::size_t> ends_;  ///< End of the preamble, then of each chunk.
    Bytes whole_ = segment_of(test::one_of_each(), &ends_);
};

}  // namespace a351::journal
