#include "protocol/journal/journal_reader.hpp"

#include <algorithm>
#include <random>
#include <system_error>
#include "tests/support/catch.hpp"

#include "protocol/journal/journal_codec.hpp"
#include "protocol/journal/journal_compression.hpp"
#include "protocol/journal/journal_writer.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/files/failing_files.hpp"
#include "tests/unit/journal/journal_samples.hpp"
#include "tests/unit/journal/segment_fixture.hpp"

using namespace a351::files;

namespace a351::journal {

TEST_CASE_METHOD(Fixture, "a tail torn at any byte costs only the chunks from there on") {
    for (std::size_t size = 0; size <= whole_.size(); ++size) {
        const auto reading = read(Bytes(whole_.begin(), whole_.begin() + std::ptrdiff_t(size)));
        std::size_t good = 0;
        while (good + 1 < ends_.size() && ends_[good + 1] <= size) ++good;
        REQUIRE(reading.chunk_count == good);
        const bool is_clean = good > 0 && ends_[good] == size;
        REQUIRE(reading.damage.has_value() == !is_clean);
        if (is_clean) continue;
        // Without its header no part of a segment is valid.
        REQUIRE(reading.damage->offset == (good > 0 ? ends_[good] : 0));
        REQUIRE(reading.damage->offset + reading.damage->byte_count == size);
    }
}

TEST_CASE_METHOD(Fixture,
                 "repair of a tail torn at any byte keeps the whole chunks and all bytes") {
    ends_.front() = 0;  // A preamble alone is not kept.
    const std::filesystem::path torn = file_.string() + ".torn";
    for (std::size_t size = 0; size <= whole_.size(); ++size) {
        const auto cut = whole_.begin() + std::ptrdiff_t(size);
        const std::size_t kept = *std::prev(std::ranges::upper_bound(ends_, size));
        test::write_bytes(file_, Bytes(whole_.begin(), cut));
        std::filesystem::remove(torn);
        const auto damage = repair_newest_segment(posix_files(), directory_.path());
        REQUIRE(damage.has_value() == (kept != size || size == 0));
        REQUIRE(std::filesystem::exists(file_) == (kept > 0));
        const auto end_of_kept = whole_.begin() + std::ptrdiff_t(kept);
        if (kept > 0) REQUIRE(test::read_bytes(file_) == Bytes(whole_.begin(), end_of_kept));
        if (!damage) continue;
        REQUIRE(damage->offset == kept);
        REQUIRE(test::read_bytes(torn) == Bytes(end_of_kept, cut));
        REQUIRE_FALSE(repair_newest_segment(posix_files(), directory_.path()));  // nothing left
    }
    CHECK_FALSE(repair_newest_segment(posix_files(), directory_.path() / "absent"));
}

TEST_CASE_METHOD(Fixture, "a flipped bit costs the chunk that it is in, and no other") {
    for (std::size_t at = 0; at < 8 * whole_.size(); ++at) {
        auto bytes = whole_;
        bytes[at / 8] ^= static_cast<std::byte>(1U << (at % 8));
        const auto reading = read(bytes);
        REQUIRE(reading.damage);
        if (at / 8 < ends_[1]) {  // Without its header no part of a segment is valid.
            REQUIRE(reading.chunk_count == 0);
            REQUIRE(reading.damage->byte_count == whole_.size());
            continue;
        }
        const auto end = std::ranges::upper_bound(ends_, at / 8);
        REQUIRE(reading.chunk_count == 7);
        REQUIRE(reading.damage->offset == *(end - 1));
        REQUIRE(reading.damage->offset + reading.damage->byte_count == *end);
        REQUIRE(reading.damage->next_sequence.has_value() == (*end != whole_.size()));
    }
}

TEST_CASE_METHOD(Fixture, "bytes of zeros inside a segment cost only the chunks in them") {
    std::vector<Chunk> chunks{test::journal_header()};
    for (int i = 0; i < 100; ++i) chunks.push_back(test::rx_chunk("0123456789", "abcdefghij"));
    const auto whole = segment_of(chunks);
    const std::size_t size = encode_chunk(chunks[1], 1).size();
    for (std::size_t at = 700; at + 300 < whole.size() - size; at += 7) {
        auto bytes = whole;
        std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), 300, std::byte{0});
        const auto reading = read(bytes);
        REQUIRE(reading.chunk_count >= chunks.size() - (300 / size + 2));
        REQUIRE(reading.chunk_count < chunks.size());
        REQUIRE(std::ranges::is_sorted(reading.sequences));
        REQUIRE(reading.sequences.back() == chunks.size() - 1);
    }
}

TEST_CASE_METHOD(Fixture, "random damage never crashes the reader") {
    std::mt19937_64 random(11);
    for (int round = 0; round < 2000; ++round) {
        auto bytes = whole_;
        for (int i = 0; i < 6; ++i) {
            bytes[random() % bytes.size()] = static_cast<std::byte>(random() & 0xFF);
        }
        REQUIRE(read(bytes).chunk_count <= 8);
    }
}

TEST_CASE_METHOD(Fixture, "bytes that are no chunk of a segment are damage from there to the end") {
    const auto header = segment_of({test::journal_header()});
    const auto behind = [](Bytes bytes, const Bytes& more) {
        append(bytes, more);
        return bytes;
    };
    const auto chunk = segment_of({test::journal_header(), test::rx_chunk("a", "b")});
    auto other_version = whole_;
    other_version[8] = std::byte{2};
    Bytes too_long(200'004);
    std::fill_n(too_long.begin(), 4, std::byte{0xFF});  // A length above 64 KiB.
    struct Case {
        Bytes bytes;
        std::size_t good, offset;
        const char* reason;
    };
    for (const auto& [bytes, good, offset, reason] : {
             Case{behind(header, too_long), 1, header.size(), "impossible length"},
             Case{behind(chunk, encode_chunk(test::rx_chunk("c", "d"), 1)), 2, chunk.size(),
                  "wrong sequence number"},
             Case{segment_of({test::journal_header(), test::journal_header()}), 1, header.size(),
                  "header inside the segment"},
             Case{segment_of({test::rx_chunk("a", "b")}), 0, 0, "no header"},
             Case{encode_preamble(), 0, 0, "no header"},
             Case{other_version, 0, 0, "not a journal of this version"},
             Case{Bytes(100, std::byte{'x'}), 0, 0, "not a journal of this version"},
             // Zeros, as a file system may leave after a power cut.
             Case{behind(whole_, Bytes(4096)), 8, whole_.size(), nullptr},
         }) {
        const auto reading = read(bytes);
        CHECK(reading.chunk_count == good);
        REQUIRE(reading.damage);
        CHECK(reading.damage->offset == offset);
        CHECK(reading.damage->offset + reading.damage->byte_count == bytes.size());
        if (reason != nullptr) CHECK(reading.damage->reason == reason);
    }
    CHECK_THROWS_AS(Reader("/nonexistent/1.a351j"), std::system_error);
}

TEST_CASE_METHOD(Fixture, "a chunk of an unknown type is skipped") {
    auto bytes = segment_of({test::journal_header()});
    auto unknown = encode_chunk(EventChunk{"of a later version"}, 1);
    unknown[4] = std::byte{200};
    auto header = decode_chunk_header(std::span(unknown).first(kChunkHeaderSize));
    header.crc = chunk_crc(header, std::span(unknown).subspan(kChunkHeaderSize));
    for (std::size_t i = 0; i < 4; ++i) {
        unknown[9 + i] = static_cast<std::byte>(header.crc >> (8 * i) & 0xFF);
    }
    append(bytes, unknown);
    append(bytes, encode_chunk(test::rx_chunk("a", "b"), 2));
    const auto reading = read(bytes);
    CHECK(reading.chunk_count == 2);
    CHECK_FALSE(reading.damage);
}

TEST_CASE("chunks that a later segment repeats are read once and in order, whatever is damaged") {
    // Chunks 1 ... 6 of segment 1; segment 2, given up, and segment 3 repeat those from 4 on.
    const auto text_of = [](int i) { return test::rx_chunk(std::string(20, char('a' + i)), "z"); };
    const auto bytes_of = [&](std::optional<RepeatedChunks> repeats, int first, int last) {
        Header header = test::journal_header();
        header.repeats = repeats;
        std::vector<Chunk> chunks{header};
        for (int i = first; i <= last; ++i) chunks.push_back(text_of(i));
        return segment_of(chunks);
    };
    const RepeatedChunks from{1, 4};
    const std::vector<Bytes> segments{bytes_of({}, 1, 6), bytes_of(from, 4, 7),
                                      bytes_of(from, 4, 9)};
    const std::size_t size = encode_chunk(text_of(1), 1).size();
    for (int damaged = 0; damaged < 2; ++damaged) {
        const int chunks = damaged == 0 ? 6 : 4;
        for (int k = 1; k <= chunks; ++k) {
            const test::TemporaryDirectory directory;
            for (int i = 0; i < 3; ++i) {
                auto bytes = segments[std::size_t(i)];
                if (i == damaged)
                    bytes[bytes.size() - std::size_t(chunks - k + 1) * size + 20] ^= std::byte{1};
                test::write_bytes(directory.path() / ("0000000" + std::to_string(i + 1) +
                                                      "_20260301T130000Z.a351j"),
                                  bytes);
            }
            Sequence sequence(segment_files(directory.path()));
            std::string read;
            while (const auto chunk = sequence.next())
                if (const auto* rx = std::get_if<RxChunk>(&*chunk))
                    read += static_cast<char>(rx->bytes.front());
            std::string expected = "bcdefghij";
            // Only chunks that no other segment repeats are lost.
            if (damaged == 0 && k < 4) expected.erase(std::size_t(k - 1), 1);
            INFO("segment " << damaged + 1 << ", chunk " << k);
            CHECK(read == expected);
            CHECK(sequence.damage().size() == 1);
        }
    }
}

TEST_CASE("segments are listed in the order of their counter, whatever the host clock showed") {
    const test::TemporaryDirectory directory;
    for (const char* name :
         {"00000010_20260301T120000Z.a351j", "00000009_20270101T000000Z.a351j",
          "100000000_20200101T000000Z.a351j", "notes.txt", "00000011_20260301T120000Z.a351j.torn",
          "00000008_20260301T120000Z.a351j.zst", "00000010_20260301T120000Z.a351j.zst",
          "00000007_20260301T120000Z.a351j.zst.partial", "x_y.a351j"}) {
        test::write_bytes(directory.path() / name, {});
    }
    const auto segments = segment_files(directory.path());
    REQUIRE(segments.size() == 4);
    CHECK(segment_number(segments[0]) == 8U);
    CHECK(segment_number(segments[1]) == 9U);
    CHECK(segments[2].filename() == "00000010_20260301T120000Z.a351j");
    CHECK(segment_number(segments[3]) == 100'000'000U);
    CHECK(segment_files(directory.path() / "absent").empty());
}

TEST_CASE(
    "segments that a journal lacks are named, but for torn ones and those before the oldest") {
    const test::TemporaryDirectory directory;
    for (const char* name :
         {"00000003_20260301T120000Z.a351j.zst", "00000004_20260301T130000Z.a351j.torn",
          "00000007_20260301T160000Z.a351j", "00000008_20260301T170000Z.a351j",
          "00000010_20260301T190000Z.a351j", "lost+found"})
        directory.write(name, "");
    const auto absent = absent_segments(directory.path());
    REQUIRE(absent.size() == 2);
    CHECK(absent[0].first == 5U);
    CHECK(absent[0].last == 6U);
    CHECK(absent[0].before.filename() == "00000004_20260301T130000Z.a351j.torn");
    CHECK(absent[0].after.filename() == "00000007_20260301T160000Z.a351j");
    CHECK(absent[1].first == 9U);
    CHECK(absent[1].last == 9U);
}

TEST_CASE_METHOD(Fixture, "repair copies nothing from a file to which a link leads") {
    auto torn = whole_;
    append(torn, Bytes(17, std::byte{0xAA}));
    const auto victim = directory_.path() / "victim";
    test::write_bytes(victim, torn);
    std::filesystem::remove(file_);
    std::filesystem::create_symlink(victim, file_);
    CHECK_THROWS_WITH(repair_newest_segment(posix_files(), directory_.path()),
                      file_.string() + " is a link; links in a data root are not followed");
    CHECK_FALSE(std::filesystem::exists(file_.string() + ".torn"));
    CHECK(test::read_bytes(victim) == torn);
}

TEST_CASE_METHOD(Fixture, "repair leaves good chunks behind damage in their place") {
    auto damaged = whole_;
    damaged[ends_[1] + 15] ^= std::byte{4};  // in the second chunk
    test::write_bytes(file_, damaged);
    CHECK_FALSE(repair_newest_segment(posix_files(), directory_.path()));
    CHECK(test::read_bytes(file_) == damaged);
    CHECK(read_all(file_).chunk_count == 7);
}

TEST_CASE_METHOD(Fixture,
                 "repair moves a segment without a header away, and its number stays used") {
    test::write_bytes(file_, Bytes(whole_.begin(), whole_.begin() + 20));
    REQUIRE(repair_newest_segment(posix_files(), directory_.path()));
    CHECK(std::filesystem::file_size(file_.string() + ".torn") == 20);
    CHECK(segment_files(directory_.path()).empty());
    CHECK_FALSE(repair_newest_segment(posix_files(), directory_.path()));
    Writer writer(posix_files(), directory_.path());
    writer.begin_segment(test::journal_header());
    CHECK(segment_number(segment_files(directory_.path()).back()) == 2U);
}

TEST_CASE("writing reproduces the reference segment byte for byte") {
    const auto expected = test::read_bytes(A351_GOLDEN "/journal/00000001_20260301T130000Z.a351j");
    CHECK(segment_of(test::one_of_each()) == expected);
    const auto reading = read_all(A351_GOLDEN "/journal/00000001_20260301T130000Z.a351j");
    CHECK(reading.chunk_count == 8);
    CHECK_FALSE(reading.damage);
}

}  // namespace a351::journal
