#include "sim/line/frame_damage.hpp"

#include <algorithm>
#include "tests/support/catch.hpp"

#include "protocol/wire/burst_frame.hpp"

using namespace a351;
using namespace a351::sim::line;
using namespace a351::sim::noise;

namespace {

Bytes frame() {
    wire::BurstValues values;
    values.flag = 0x8E00;
    values.temperature = 2466;
    values.axes = {-203896, 604794, 16713252};
    values.count = 80;
    Bytes bytes;
    wire::append_frame(wire::BurstLayout::recommended(), values, bytes);
    return bytes;
}

bool holds(const Bytes& bytes, const Bytes& frame) {
    return std::ranges::search(bytes, frame).begin() != bytes.end();
}

std::size_t bits_apart(const Bytes& a, const Bytes& b) {
    std::size_t bits = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (auto rest = std::to_integer<unsigned>(a[i] ^ b[i]); rest != 0; rest &= rest - 1)
            ++bits;
    }
    return bits;
}

}  // namespace

TEST_CASE("a damaged frame does not contain the original frame") {
    // 200 000 draws: each place and value of one byte is tried 30 times, also a second end marker.
    const Bytes whole = frame();
    RandomStream random(1, "test");
    for (int i = 0; i < 200'000; ++i) {
        REQUIRE_FALSE(holds(with_more_bytes(whole, 1, random), whole));
    }
    for (int i = 0; i < 2000; ++i) {
        REQUIRE_FALSE(holds(with_more_bytes(whole, 1 + i % 50, random), whole));
        REQUIRE(without_bytes(whole, 1 + i % 50, random).size() ==
                24 - std::min<std::size_t>(1 + static_cast<std::size_t>(i) % 50, 23));
        const Bytes front = cut_short(whole, random);
        REQUIRE((!front.empty() && front.size() < 24));
        REQUIRE(std::equal(front.begin(), front.end(), whole.begin()));
    }
}

TEST_CASE("the requested number of bits is flipped, in one word or marker") {
    const Bytes whole = frame();
    RandomStream random(1, "test");
    for (int i = 0; i < 5000; ++i) {
        const int bits = 1 + i % 16;
        const Bytes flipped = with_flipped_bits(whole, bits, random);
        const auto first = std::ranges::mismatch(whole, flipped).in1 - whole.begin();
        const bool is_marker = first == 0 || first == 23;
        REQUIRE(bits_apart(whole, flipped) ==
                static_cast<std::size_t>(is_marker ? std::min(bits, 8) : bits));
        REQUIRE((is_marker || !has_right_checksum(flipped)));
    }
}

TEST_CASE("a bad checksum leaves the rest of the frame unchanged") {
    const Bytes whole = frame();
    REQUIRE(has_right_checksum(whole));
    RandomStream random(1, "test");
    for (int i = 0; i < 1000; ++i) {
        const Bytes bad = with_bad_checksum(whole, random);
        REQUIRE_FALSE(has_right_checksum(bad));
        REQUIRE(std::equal(bad.begin(), bad.begin() + 21, whole.begin()));
        REQUIRE(bad.back() == whole.back());
    }
}

TEST_CASE("even without a checksum, a million inserted bytes contain no frame") {
    wire::BurstValues values;
    values.temperature = 2466;
    values.axes = {-203896, 604794, 16713252};
    values.count = 80;
    const auto layout = *wire::BurstLayout::from_burst_ctrl(0x4702);  // The factory's.
    Bytes whole;
    wire::append_frame(layout, values, whole);
    const auto frames_in = [&whole](const Bytes& bytes) {
        std::size_t frames = 0;
        for (std::size_t i = 0; i + whole.size() <= bytes.size(); ++i) {
            frames += bytes[i] == wire::kStartByte && bytes[i + whole.size() - 1] == wire::kEndByte;
        }
        return frames;
    };
    RandomStream random(1, "test");
    for (const int count : {1, 2, 19, 20, 21, 1'000'000}) {
        CAPTURE(count);
        const Bytes longer = with_more_bytes(whole, count, random);
        CHECK(longer.size() == whole.size() + static_cast<std::size_t>(count));
        CHECK(frames_in(longer) == 0);
        Bytes garbage = garbage_before(whole, count, random);
        CHECK(garbage.size() == static_cast<std::size_t>(count));
        garbage.insert(garbage.end(), whole.begin(), whole.end());
        CHECK(frames_in(garbage) == 1);
    }
    // With markers everywhere a whole frame cannot be avoided.  The function must still end.
    Bytes markers(whole.size(), wire::kStartByte);
    std::fill(markers.begin() + 10, markers.end(), wire::kEndByte);
    CHECK(with_more_bytes(markers, 1, random).size() == markers.size() + 1);
}
