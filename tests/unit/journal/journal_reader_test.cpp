#include "protocol/journal/journal_reader.hpp"

#include <random>
#include <system_error>
#include "tests/support/catch.hpp"

#include "protocol/journal/journal_codec.hpp"
#include "protocol/journal/journal_compression.hpp"
#include "protocol/journal/journal_writer.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/files/failing_files.hpp"
#include "tests/unit/journal/journal_samples.hpp"

using namespace a351::files;

namespace a351::journal {
namespace {

using Bytes = std::vector<std::byte>;

void append(Bytes& bytes, const Bytes& more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
}

/// Returns a segment of the given chunks, numbered from 0.
Bytes segment_of(const std::vector<Chunk>& chunks) {
    auto bytes = encode_preamble();
    std::uint32_t sequence = 0;
    for (const auto& chunk : chunks) append(bytes, encode_chunk(chunk, sequence++));
    return bytes;
}

struct Reading {
    std::size_t chunk_count = 0;
    std::optional<Damage> damage;
};

Reading read_all(const std::filesystem::path& file) {
    Reader reader(file);
    Reading reading;
    while (reader.next()) ++reading.chunk_count;
    CHECK_FALSE(reader.next());
    reading.damage = reader.damage();
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
    Bytes whole_ = segment_of(test::one_of_each());
};

}  // namespace

TEST_CASE_METHOD(Fixture, "an intact segment is read without damage", "[record][journal]") {
    const auto reading = read(whole_);
    CHECK(reading.chunk_count == 8);
    CHECK_FALSE(reading.damage);
}

TEST_CASE_METHOD(Fixture, "a tail torn at any byte costs only the chunks from there on",
                 "[record][journal]") {
    std::vector<std::size_t> ends{kPreambleSize};
    std::uint32_t sequence = 0;
    for (const auto& chunk : test::one_of_each()) {
        ends.push_back(ends.back() + encode_chunk(chunk, sequence++).size());
    }
    for (std::size_t size = 0; size <= whole_.size(); ++size) {
        const auto reading = read(Bytes(whole_.begin(), whole_.begin() + std::ptrdiff_t(size)));
        std::size_t good = 0;
        while (good + 1 < ends.size() && ends[good + 1] <= size) ++good;
        REQUIRE(reading.chunk_count == good);
        const bool is_clean = good > 0 && ends[good] == size;
        REQUIRE(reading.damage.has_value() == !is_clean);
        if (is_clean) continue;
        // Without its header no part of a segment is valid.
        REQUIRE(reading.damage->offset == (good > 0 ? ends[good] : 0));
        REQUIRE(reading.damage->offset + reading.damage->byte_count == size);
    }
}

TEST_CASE_METHOD(Fixture, "any single flipped bit is detected, and the chunks before it are kept",
                 "[record][journal]") {
    for (std::size_t at = 0; at < whole_.size(); ++at) {
        auto bytes = whole_;
        bytes[at] ^= static_cast<std::byte>(1U << (at % 8));
        const auto reading = read(bytes);
        REQUIRE(reading.damage);
        REQUIRE(reading.damage->offset <= at);
        REQUIRE(reading.chunk_count < 8);
    }
}

TEST_CASE_METHOD(Fixture, "random damage never crashes the reader", "[record][journal]") {
    std::mt19937_64 random(11);
    for (int round = 0; round < 2000; ++round) {
        auto bytes = whole_;
        for (int i = 0; i < 6; ++i) {
            bytes[random() % bytes.size()] = static_cast<std::byte>(random() & 0xFF);
        }
        REQUIRE(read(bytes).chunk_count <= 8);
    }
}

TEST_CASE_METHOD(Fixture, "a chunk length above 64 KiB ends the segment", "[record][journal]") {
    auto bytes = segment_of({test::journal_header()});
    const auto good = bytes.size();
    append(bytes, {std::byte{0xFF}, std::byte{0xFF}, std::byte{0xFF}, std::byte{0xFF}});
    bytes.resize(bytes.size() + 200'000);
    const auto reading = read(bytes);
    CHECK(reading.chunk_count == 1);
    CHECK(reading.damage->offset == good);
    CHECK(reading.damage->reason == "impossible length");
}

TEST_CASE_METHOD(Fixture, "a repeated sequence number ends the segment", "[record][journal]") {
    auto bytes = encode_preamble();
    append(bytes, encode_chunk(test::journal_header(), 0));
    append(bytes, encode_chunk(test::rx_chunk("a", "b"), 1));
    append(bytes, encode_chunk(test::rx_chunk("c", "d"), 1));
    const auto reading = read(bytes);
    CHECK(reading.chunk_count == 2);
    CHECK(reading.damage->reason == "wrong sequence number");
}

TEST_CASE_METHOD(Fixture, "a file that does not begin with a header is not a segment",
                 "[record][journal]") {
    auto reading = read(segment_of({test::rx_chunk("a", "b")}));
    CHECK(reading.chunk_count == 0);
    CHECK(reading.damage->offset == 0);
    CHECK(reading.damage->reason == "no header");
    reading = read(encode_preamble());
    CHECK(reading.damage->reason == "no header");
}

TEST_CASE_METHOD(Fixture, "a second header ends the segment", "[record][journal]") {
    const auto reading = read(segment_of({test::journal_header(), test::journal_header()}));
    CHECK(reading.chunk_count == 1);
    CHECK(reading.damage->reason == "header inside the segment");
}

TEST_CASE_METHOD(Fixture, "garbage after the last good chunk is reported with its size",
                 "[record][journal]") {
    auto bytes = whole_;
    bytes.resize(bytes.size() + 4096);  // Zeros, as a file system may leave after a power cut.
    const auto reading = read(bytes);
    CHECK(reading.chunk_count == 8);
    CHECK(reading.damage->offset == whole_.size());
    CHECK(reading.damage->byte_count == 4096);
}

TEST_CASE_METHOD(Fixture, "a chunk of an unknown type is skipped", "[record][journal]") {
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

TEST_CASE_METHOD(Fixture, "a file of another version or of another kind is refused",
                 "[record][journal]") {
    auto bytes = whole_;
    bytes[8] = std::byte{2};
    CHECK(read(bytes).damage->reason == "not a journal of this version");
    CHECK(read(Bytes(100, std::byte{'x'})).damage->reason == "not a journal of this version");
}

TEST_CASE("opening a segment that does not exist is a system error", "[record][journal]") {
    CHECK_THROWS_AS(Reader("/nonexistent/1.a351j"), std::system_error);
}

TEST_CASE_METHOD(Fixture, "a compressed segment reads like the original", "[record][journal]") {
    test::write_bytes(file_, whole_);
    compress_segment(posix_files(), file_);
    CHECK_FALSE(std::filesystem::exists(file_));
    const auto segments = segment_files(directory_.path());
    REQUIRE(segments.size() == 1);
    Reader reader(segments[0]);
    for (const auto& chunk : test::one_of_each()) {
        const auto read = reader.next();
        REQUIRE(read);
        CHECK(read->index() == chunk.index());
    }
    CHECK_FALSE(reader.next());
    CHECK_FALSE(reader.damage());
    CHECK_FALSE(repair_newest_segment(posix_files(), directory_.path()));
}

TEST_CASE_METHOD(Fixture,
                 "damage in a compressed segment is reported and never thrown as an exception",
                 "[record][journal]") {
    test::write_bytes(file_, whole_);
    compress_segment(posix_files(), file_);
    const auto packed = segment_files(directory_.path()).front();
    const auto whole = test::read_bytes(packed);
    for (std::size_t at = 0; at < whole.size(); ++at) {
        auto damaged = whole;
        damaged[at] ^= std::byte{0x20};
        test::write_bytes(packed, damaged);
        Reader reader(packed);
        while (reader.next()) {
        }
        test::write_bytes(packed, Bytes(whole.begin(), whole.begin() + static_cast<long>(at)));
        Reader cut(packed);
        CHECK_FALSE(cut.next());
        CHECK(cut.damage());
    }
}

TEST_CASE_METHOD(Fixture, "whichever file operation fails, compressing leaves a readable segment",
                 "[record][journal]") {
    for (int n = 1; n <= 8; ++n) {
        test::write_bytes(file_, whole_);
        test::FailingFiles files(n);
        bool has_failed = false;
        try {
            compress_segment(files, file_);
        } catch (const std::system_error&) {
            has_failed = true;
        }
        const auto segments = segment_files(directory_.path());
        REQUIRE(segments.size() == 1);
        Reader reader(segments[0]);
        while (reader.next()) {
        }
        CHECK_FALSE(reader.damage());
        CHECK(has_failed == (n <= files.operations()));
        for (const auto& file : std::filesystem::directory_iterator(directory_.path()))
            std::filesystem::remove(file);
    }
}

TEST_CASE("segments are listed in the order of their counter, whatever the host clock showed",
          "[record][journal]") {
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

TEST_CASE_METHOD(Fixture,
                 "repair moves a torn tail to a side file, and then has nothing left to do",
                 "[record][journal]") {
    auto torn = whole_;
    const Bytes rest(17, std::byte{0xAA});
    append(torn, rest);
    test::write_bytes(file_, torn);
    const auto damage = repair_newest_segment(posix_files(), directory_.path());
    REQUIRE(damage);
    CHECK(damage->offset == whole_.size());
    CHECK(test::read_bytes(file_) == whole_);
    CHECK(test::read_bytes(file_.string() + ".torn") == rest);
    CHECK_FALSE(repair_newest_segment(posix_files(), directory_.path()));
}

TEST_CASE_METHOD(Fixture, "repair moves a segment without a header out of the way",
                 "[record][journal]") {
    test::write_bytes(file_, Bytes(whole_.begin(), whole_.begin() + 20));
    REQUIRE(repair_newest_segment(posix_files(), directory_.path()));
    CHECK_FALSE(std::filesystem::exists(file_));
    CHECK(std::filesystem::file_size(file_.string() + ".torn") == 20);
    CHECK(segment_files(directory_.path()).empty());
    CHECK_FALSE(repair_newest_segment(posix_files(), directory_.path()));
    // Its number is not used again.
    Writer writer(posix_files(), directory_.path());
    writer.begin_segment(test::journal_header());
    CHECK(segment_number(segment_files(directory_.path()).back()) == 2U);
}

TEST_CASE("repair of an empty or absent directory does nothing", "[record][journal]") {
    const test::TemporaryDirectory directory;
    CHECK_FALSE(repair_newest_segment(posix_files(), directory.path()));
    CHECK_FALSE(repair_newest_segment(posix_files(), directory.path() / "absent"));
}

TEST_CASE("writing reproduces the reference segment byte for byte", "[record][journal]") {
    const auto expected = test::read_bytes(A351_GOLDEN "/journal/00000001_20260301T130000Z.a351j");
    CHECK(segment_of(test::one_of_each()) == expected);
    const auto reading = read_all(A351_GOLDEN "/journal/00000001_20260301T130000Z.a351j");
    CHECK(reading.chunk_count == 8);
    CHECK_FALSE(reading.damage);
}

}  // namespace a351::journal
