#include "tests/support/catch.hpp"

#include "tests/unit/wire/burst_stream.hpp"

namespace a351::wire {
namespace {

constexpr unsigned kBefore = 2;  // frames that synchronise the decoder
constexpr unsigned kFrames = 5;

}  // namespace

TEST_CASE("any single flipped bit of five frames loses exactly the frame it hits") {
    for (const int burst_ctrl : {0xC703, 0x4703, 0x0701, 0x0401}) {
        const BurstLayout layout = layout_of(burst_ctrl);
        const Bytes before = frames(layout, 0, kBefore);
        const Bytes clean = frames(layout, kBefore, kFrames);
        for (std::size_t bit = 0; bit < 8 * clean.size(); ++bit) {
            CAPTURE(burst_ctrl, bit);
            Bytes hit = clean;
            hit[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
            const auto lost = static_cast<unsigned>(kBefore + bit / 8 / layout.frame_size());
            REQUIRE(frames_in(decode(layout, joined({before, hit}))) ==
                    values_except(layout, 0, kBefore + kFrames, lost));
        }
    }
}

TEST_CASE("a flipped bit within a stream discards one frame in one run") {
    const BurstLayout layout = BurstLayout::recommended();
    for (std::size_t at = 0; at < layout.frame_size(); ++at) {
        CAPTURE(at);
        Bytes stream = frames(layout, 0, 5);
        stream[2 * layout.frame_size() + at] ^= std::byte{0x04};
        const auto events = decode(layout, stream);
        REQUIRE(events.size() == 5);
        CHECK(events[2].discarded == layout.frame_size());
        CHECK(events[2].reason == (at == 0    ? Discarded::Reason::no_start_byte
                                   : at == 23 ? Discarded::Reason::bad_end_byte
                                              : Discarded::Reason::bad_checksum));
    }
}

TEST_CASE("a dropped byte costs one frame") {
    const BurstLayout layout = BurstLayout::recommended();
    const Bytes clean = frames(layout, 0, 6);
    for (std::size_t at = 2 * layout.frame_size(); at < 5 * layout.frame_size(); ++at) {
        CAPTURE(at);
        Bytes stream = clean;
        stream.erase(stream.begin() + static_cast<std::ptrdiff_t>(at));
        const auto lost = static_cast<unsigned>(at / layout.frame_size());
        REQUIRE(frames_in(decode(layout, stream)) == values_except(layout, 0, 6, lost));
    }
}

TEST_CASE("inserted bytes, also an answer to a register read, cost at most the frame they split") {
    const BurstLayout layout = BurstLayout::recommended();
    const Bytes clean = frames(layout, 0, 6);
    for (std::size_t at = 2 * layout.frame_size(); at < 4 * layout.frame_size(); ++at) {
        for (const auto& inserted : {to_bytes({0x00}), to_bytes({0x0D}), to_bytes({0x80}),
                                     to_bytes({0xFF}), to_bytes({0x02, 0x00, 0x00, 0x0D})}) {
            CAPTURE(at, inserted.size());
            Bytes stream = clean;
            stream.insert(stream.begin() + static_cast<std::ptrdiff_t>(at), inserted.begin(),
                          inserted.end());
            const auto split = static_cast<unsigned>(at / layout.frame_size());
            const bool is_between = at % layout.frame_size() == 0;
            const auto found = frames_in(decode(layout, stream));
            // A byte equal to its neighbour may be outside the frame after all.
            if (found.size() < 6) REQUIRE(found == values_except(layout, 0, 6, split));
            if (is_between) REQUIRE(found.size() == 6);
        }
    }
}

TEST_CASE("frames hidden by a false header are found") {
    const BurstLayout layout = BurstLayout::recommended();
    for (std::size_t ahead = 1; ahead < 2 * layout.frame_size(); ++ahead) {
        CAPTURE(ahead);
        // Byte 9 of each frame is an end byte. It fits a false header 14 bytes before the frame.
        Bytes stream(ahead, kStartByte);
        std::vector<BurstValues> sent;
        for (unsigned i = 0; i < 4; ++i) {
            sent.push_back(values_at(layout, i));
            sent.back().axes = {0x0D0D0D0D, 0x0D800D80, 0x000D8080};
            append_frame(layout, sent.back(), stream);
        }
        REQUIRE(frames_in(decode(layout, stream)) == sent);
        const auto in_step = decode(layout, joined({frames(layout, 900, 2), stream}));
        REQUIRE(frames_in(in_step).size() == 6);
    }
}

TEST_CASE("a false frame with valid markers and checksum hides none of the frames it overlaps") {
    const BurstLayout layout = layout_of(0x0703);
    Bytes stream = to_bytes({0x80, 0x7F, 0xFF, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x00, 0x01});
    std::vector<BurstValues> sent;
    for (unsigned i = 0; i < 5; ++i) {
        sent.push_back(values_at(layout, i));
        sent.back().axes[0] = 0x000D1234;  // 80 00 0D: checksum and end byte of the false frame
        append_frame(layout, sent.back(), stream);
    }
    REQUIRE(burst_checksum(std::span(stream).subspan(1, 14)) == 0x8000);
    const auto events = decode(layout, stream);
    CHECK(frames_in(events) == sent);
    CHECK(events.front().reason == Discarded::Reason::unconfirmed);
    CHECK(events.front().discarded == 15);
}

TEST_CASE("10 kB of noise hold no frame") {
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        CAPTURE(seed);
        for (const bool is_rich_in_markers : {false, true}) {
            const Bytes noise = garbage(seed, 10'000, is_rich_in_markers);
            REQUIRE(frames_in(decode(BurstLayout::recommended(), noise)).empty());
            REQUIRE(frames_in(decode(layout_of(0x4702), noise)).empty());
        }
        const Bytes noise = garbage(seed, 10'000, false);
        REQUIRE(frames_in(decode(layout_of(0x0400), noise)).empty());
        REQUIRE(frames_in(decode(layout_of(0x0401), noise)).empty());
    }
}

}  // namespace a351::wire
