#include "protocol/journal/journal_compression.hpp"

#include <zstd.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <system_error>
#include "tests/support/catch.hpp"

#include "tests/support/long_tests.hpp"
#include "tests/unit/files/failing_files.hpp"
#include "tests/unit/files/forgetful_files.hpp"
#include "tests/unit/journal/segment_fixture.hpp"

using namespace a351::files;

namespace a351::journal {
namespace {

constexpr std::size_t kSizeFrame = 16;

class Compressed : public Fixture {
protected:
    /// Compresses a segment.
    /// @return its file
    std::filesystem::path compressed(const Bytes& bytes) {
        test::write_bytes(file_, bytes);
        compress_segment(posix_files(), file_);
        CHECK_FALSE(std::filesystem::exists(file_));
        const auto segments = segment_files(directory_.path());
        REQUIRE(segments.size() == 1);
        return segments.front();
    }
};

/// Returns where the frames of a compressed segment begin, and its end.
std::vector<std::size_t> frames_of(const Bytes& packed) {
    std::vector<std::size_t> frames{kSizeFrame};
    while (frames.back() < packed.size())
        frames.push_back(frames.back() +
                         ZSTD_findFrameCompressedSize(packed.data() + frames.back(),
                                                      packed.size() - frames.back()));
    return frames;
}

}  // namespace

TEST_CASE_METHOD(Compressed, "a compressed segment reads like the original") {
    const auto reading = read_all(compressed(whole_));
    CHECK(reading.kinds == kinds_of(test::one_of_each()));
    CHECK_FALSE(reading.damage);
    CHECK_FALSE(repair_newest_segment(posix_files(), directory_.path()));
}

TEST_CASE_METHOD(Fixture, "a file to which a link leads is not compressed") {
    const auto victim = directory_.path() / "victim";
    test::write_bytes(victim, whole_);
    std::filesystem::create_symlink(victim, file_);
    CHECK_THROWS_WITH(compress_segment(posix_files(), file_),
                      file_.string() + " is a link; links in a data root are not followed");
    CHECK(std::filesystem::exists(victim));
    CHECK_FALSE(std::filesystem::exists(file_.string() + ".zst"));
    CHECK_FALSE(std::filesystem::exists(file_.string() + ".zst.partial"));
}

TEST_CASE_METHOD(Compressed,
                 "damage in a compressed segment is reported and never thrown as an exception") {
    const auto packed = compressed(whole_);
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
        CHECK_FALSE(cut.damage().empty());
    }
}

namespace {

/// Returns a segment of four MiB of bytes that hardly compress, in chunks of about 200 bytes.
Bytes long_segment(std::uint32_t& chunk_count) {
    std::mt19937_64 random(3);
    auto bytes = encode_preamble();
    append(bytes, encode_chunk(test::journal_header(), 0));
    chunk_count = 1;
    while (bytes.size() < std::size_t{4} << 20) {
        std::string text(180, ' ');
        for (char& letter : text) letter = static_cast<char>('a' + random() % 16);
        append(bytes, encode_chunk(test::rx_chunk(text, "z"), chunk_count++));
    }
    return bytes;
}

}  // namespace

TEST_CASE_METHOD(Compressed,
                 "a flipped bit in a compressed segment costs at most one of its frames") {
    std::uint32_t chunk_count = 0;
    const auto packed = compressed(long_segment(chunk_count));
    const auto whole = test::read_bytes(packed);
    REQUIRE(read_all(packed).chunk_count == chunk_count);
    const std::vector<std::size_t> frames = frames_of(whole);
    REQUIRE(frames.size() == 10);  // Eight of 512 KiB, the rest, and the end.

    // A long test flips all bits of the stated size and of the begin of two frames.  A short one
    // flips every seventh bit, and at one frame only.
    const std::size_t step = test::is_long() ? 1 : 7;
    std::vector<std::size_t> bits;
    for (std::size_t bit = 0; bit < 8 * kSizeFrame; bit += step) bits.push_back(bit);
    const std::vector<std::size_t> begins =
        test::is_long() ? std::vector{frames[3], frames[8]} : std::vector{frames[8]};
    for (const std::size_t frame : begins)
        for (std::size_t bit = 0; bit < 8U * 13U; bit += step) bits.push_back(8 * frame + bit);
    std::mt19937_64 random(5);
    const int random_flips = test::is_long() ? 100 : 12;
    // The first frame has the header, without which the segment is lost.
    for (int i = 0; i < random_flips; ++i)
        bits.push_back(8 * frames[1] + random() % (8 * (whole.size() - frames[1])));

    double lost = 0.0;
    std::size_t most_lost = 0;
    for (const std::size_t bit : bits) {
        auto damaged = whole;
        damaged[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
        test::write_bytes(packed, damaged);
        const auto reading = read_all(packed);
        REQUIRE(std::ranges::is_sorted(reading.sequences));
        const std::size_t missing = chunk_count - reading.chunk_count;
        INFO("bit " << bit);
        if (bit < 8 * kSizeFrame) CHECK(missing == 0);
        lost += static_cast<double>(missing);
        most_lost = std::max(most_lost, missing);
    }
    std::printf("%zu flips, %u chunks in %zu frames: %.0f lost on average, %zu at most\n",
                bits.size(), chunk_count, frames.size() - 1,
                lost / static_cast<double>(bits.size()), most_lost);
    CHECK(most_lost > 0);
    CHECK(most_lost <= chunk_count / 8 + 2);
}

TEST_CASE_METHOD(
    Compressed,
    "a compressed segment cut at any byte has the chunks before, and the rest is damage") {
    std::vector<Chunk> chunks(45, test::rx_chunk(std::string(30'000, 'a'), "z"));
    chunks.front() = test::journal_header();
    const auto bytes = segment_of(chunks, &ends_);
    ends_.erase(ends_.begin());
    const auto packed = compressed(bytes);
    const auto whole = test::read_bytes(packed);
    constexpr std::size_t kFrame = std::size_t{1} << 19;
    const std::vector<std::size_t> frames = frames_of(whole);
    REQUIRE(frames.size() == 4);  // Three of few bytes each, and the end.

    const std::size_t stride = test::is_long() ? 1 : 13;
    std::size_t cuts = 0, good = 0;
    for (std::size_t size = 0; size < whole.size(); size += stride, ++cuts) {
        test::write_bytes(packed, Bytes(whole.begin(), whole.begin() + std::ptrdiff_t(size)));
        const auto reading = read_all(packed);
        INFO("cut at " << size);
        const auto whole_frames = std::ranges::upper_bound(frames, size) - frames.begin() - 1;
        const auto unpacked =
            static_cast<std::size_t>(std::max<std::ptrdiff_t>(whole_frames, 0)) * kFrame;
        const auto least = std::ranges::upper_bound(ends_, unpacked) - ends_.begin();
        REQUIRE(reading.chunk_count >= static_cast<std::size_t>(least));
        REQUIRE(reading.chunk_count >= good);  // A longer part has no fewer chunks.
        good = reading.chunk_count;
        REQUIRE(reading.damage);
        REQUIRE((good == 0 || reading.sequences.back() == good - 1));
        if (good == 0) continue;
        REQUIRE(reading.damage->offset == ends_[good - 1]);
        REQUIRE(reading.damage->offset + reading.damage->byte_count == bytes.size());
    }
    std::printf("%zu cuts of %zu bytes in %zu frames, %zu of %zu chunks at the last\n", cuts,
                whole.size(), frames.size() - 1, good, ends_.size());
}

TEST_CASE_METHOD(Fixture,
                 "a segment of earlier versions in a single frame is read as far as possible") {
    std::uint32_t chunk_count = 0;
    const auto bytes = long_segment(chunk_count);
    Bytes packed(ZSTD_compressBound(bytes.size()));
    packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 3));
    const std::filesystem::path file = file_.string() + ".zst";
    test::write_bytes(file, packed);
    CHECK(read_all(file).chunk_count == chunk_count);
    packed.resize(packed.size() / 2);
    test::write_bytes(file, packed);
    const auto reading = read_all(file);
    std::printf("half of a frame: %zu of %u chunks\n", reading.chunk_count, chunk_count);
    CHECK(reading.chunk_count > chunk_count / 2 - chunk_count / 20);
    CHECK(reading.damage);
}

TEST_CASE_METHOD(Fixture, "whichever file operation fails, compressing leaves a readable segment") {
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
        CHECK_FALSE(read_all(segments[0]).damage);
        CHECK(has_failed == (n <= files.operations()));
        for (const auto& file : std::filesystem::directory_iterator(directory_.path()))
            std::filesystem::remove(file);
    }
}

TEST_CASE_METHOD(Fixture, "a power cut at any moment of compressing leaves a readable segment") {
    constexpr int kCuts = 20;  // at each operation; a cut loses half of what was not synced
    const auto root = directory_.path() / "root", found = directory_.path() / "found";
    std::mt19937_64 random(7);
    bool is_whole = false;
    for (int n = 0; !is_whole; ++n) {
        std::filesystem::create_directory(root);
        const auto segment = root / file_.filename();
        test::ForgetfulFiles files;
        {
            const auto file = files.create(segment);
            file->append(whole_);
            file->sync();
        }
        files.sync_directory(root);
        files.operations_left = n;
        try {
            compress_segment(files, segment);
            is_whole = true;
        } catch (const std::system_error&) {
        }
        for (int cut = 0; cut < kCuts; ++cut) {
            files.cut(root, found, random);
            const auto segments = segment_files(found);
            INFO("after " << n << " operations");
            REQUIRE(segments.size() == 1);
            const Reading reading = read_all(segments[0]);
            CHECK(reading.chunk_count == test::one_of_each().size());
            CHECK_FALSE(reading.damage);
            std::filesystem::remove_all(found);
        }
        std::filesystem::remove_all(root);
    }
}

}  // namespace a351::journal
