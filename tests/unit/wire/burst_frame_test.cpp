#include "protocol/wire/burst_frame.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include "tests/support/catch.hpp"

#include "protocol/text/csv.hpp"
#include "protocol/wire/device_profile.hpp"
#include "tests/unit/wire/burst_stream.hpp"

namespace a351::wire {
namespace {

Bytes encode(std::uint16_t burst_ctrl, const BurstValues& values) {
    Bytes bytes;
    append_frame(layout_of(burst_ctrl), values, bytes);
    return bytes;
}

/// Returns the first frame of a stream that continues with `values` at later COUNTs.
BurstValues decode_first(std::uint16_t burst_ctrl, const Bytes& frame, BurstValues values) {
    Bytes stream = frame;
    for (int i = 0; i < 2; ++i) {
        values.count = static_cast<std::uint16_t>(values.count + kStep);
        append_frame(layout_of(burst_ctrl), values, stream);
    }
    const auto events = decode(layout_of(burst_ctrl), stream);
    REQUIRE(events.size() == 3);
    REQUIRE(events.front().is_frame());
    return events.front().values;
}

void check_both_ways(std::uint16_t burst_ctrl, const Bytes& frame, const BurstValues& values) {
    CHECK(encode(burst_ctrl, values) == frame);
    CHECK(decode_first(burst_ctrl, frame, values) == values);
}

double x_g(const BurstValues& values, std::size_t axis) {
    return find_profile("A352AD10")->acceleration(values.axes[axis]).value();
}

double temperature_degc(const BurstValues& values) {
    return find_profile("A352AD10")->temperature(values.temperature).value();
}

/// Returns the offset of `pattern` in `frame`; empty if it does not occur.
std::string offset_of(const Bytes& frame, std::size_t end, const Bytes& pattern) {
    const auto last = frame.begin() + static_cast<std::ptrdiff_t>(end);
    const auto found = std::search(frame.begin(), last, pattern.begin(), pattern.end());
    return found == last ? "" : std::to_string(found - frame.begin());
}

}  // namespace

// Two flipped bits cancel in the sum if they have the same weight and opposite signs; of the highest
// bit both signs are the same modulo 65536.  With n words of data, k of which have a one at a bit:
// k (n - k) pairs of data words, and each data word whose bit equals that of the checksum; at the
// highest bit n (n - 1) / 2 and n.
TEST_CASE("the word sum sees every flipped bit, and of two all but those that cancel") {
    BurstValues values;
    values.flag = 0x8E00;
    values.temperature = -1975 * 65'536 + 12'345;
    values.axes = {123'456, -7'654'321, 16'777'216};
    values.count = 54'321;
    Bytes frame = encode(0xC703, values);
    const std::span<std::byte> words(frame.data() + 1, frame.size() - 2);
    const auto is_accepted = [&] {
        const auto data = words.first(words.size() - 2);
        return burst_checksum(data) == word_at(words, data.size());
    };
    const auto flip = [&](std::size_t bit) {
        words[bit / 8] ^= static_cast<std::byte>(0x80U >> (bit % 8));
    };
    REQUIRE(is_accepted());
    std::size_t derived = 0;
    const std::size_t n = words.size() / 2 - 1;
    for (unsigned bit = 0; bit < 16; ++bit) {
        const auto is_one = [&](std::size_t word) {
            return (unsigned{word_at(words, 2 * word)} >> bit) & 1U;
        };
        std::size_t ones = 0;
        for (std::size_t word = 0; word < n; ++word) ones += is_one(word);
        derived +=
            bit == 15 ? n * (n - 1) / 2 + n : ones * (n - ones) + (is_one(n) ? ones : n - ones);
    }
    std::size_t accepted = 0;
    const std::size_t bits = 8 * words.size();
    for (std::size_t one = 0; one < bits; ++one) {
        flip(one);
        REQUIRE_FALSE(is_accepted());
        for (std::size_t other = one + 1; other < bits; ++other) {
            flip(other);
            if (is_accepted()) ++accepted;
            flip(other);
        }
        flip(one);
    }
    std::printf("%zu of %zu errors of two bits are not seen\n", accepted, bits * (bits - 1) / 2);
    CHECK(accepted == derived);
}

TEST_CASE("each of the 112 layouts has its fields at the offsets of the reference table") {
    const auto table = text::read_csv(A351_GOLDEN "/wire/burst_layouts.csv");
    REQUIRE(table.row_count() == 112);
    const BurstValues marks{.flag = 0x1112,
                            .temperature = 0x21222324,
                            .axes = {0x31323334, 0x41424344, 0x51525354},
                            .count = 0x6162};
    for (std::size_t row = 0; row < table.row_count(); ++row) {
        CAPTURE(table.cell(row, "burst_ctrl"));
        const auto burst_ctrl =
            static_cast<std::uint16_t>(std::stoul(table.cell(row, "burst_ctrl"), nullptr, 16));
        const auto layout = BurstLayout::from_burst_ctrl(burst_ctrl);
        REQUIRE(layout.has_value());
        CHECK(layout->burst_ctrl() == burst_ctrl);
        const Bytes frame = encode(burst_ctrl, marks);
        CHECK(std::to_string(frame.size()) == table.cell(row, "size"));
        CHECK(layout->frame_size() == frame.size());
        CHECK(frame.front() == std::byte{0x80});
        CHECK(frame.back() == std::byte{0x0D});

        const std::string& checksum = table.cell(row, "checksum");
        const std::size_t end = checksum.empty() ? frame.size() - 1 : std::stoul(checksum);
        CHECK(end == frame.size() - (checksum.empty() ? 1U : 3U));
        for (const auto& [field, mark, size] :
             {std::tuple("flag", 0x11, 2U), std::tuple("temperature", 0x21, 4U),
              std::tuple("x", 0x31, 4U), std::tuple("y", 0x41, 4U), std::tuple("z", 0x51, 4U),
              std::tuple("count", 0x61, 2U)}) {
            Bytes pattern = to_bytes({mark, mark + 1, mark + 2, mark + 3});
            pattern.resize(size);
            CHECK(offset_of(frame, end, pattern) == table.cell(row, field));
        }
    }
}

TEST_CASE("exactly 112 of the 65536 values of BURST_CTRL are layouts") {
    int valid = 0;
    for (unsigned value = 0; value <= 0xFFFF; ++value) {
        if (BurstLayout::from_burst_ctrl(static_cast<std::uint16_t>(value))) ++valid;
    }
    CHECK(valid == 112);
    CHECK_FALSE(BurstLayout::from_burst_ctrl(0xC003));  // no axis
    CHECK_FALSE(BurstLayout::from_burst_ctrl(0xC707));  // bit 2 is reserved
    CHECK(BurstLayout::recommended().burst_ctrl() == 0xC703);
}

TEST_CASE("the checksum of the data sheet's example is reproduced") {
    // M-A352AD10 data sheet, rev. 20251023, 6.2.4.
    const Bytes words =
        to_bytes({0xFE, 0x01, 0xC4, 0x55, 0x40, 0x00, 0x00, 0x52, 0x33, 0xC0, 0x00, 0x43,
                  0x7B, 0xC8, 0x00, 0x4A, 0x26, 0x08, 0xFD, 0x73, 0x3A, 0xA0, 0xFF, 0x75,
                  0x4C, 0x30, 0x1F, 0x53, 0x8F, 0xD0, 0x06, 0x00, 0x00, 0x14});
    CHECK(burst_checksum(words) == 0x11B4);
}

// The raw values of the next test are from the register dump of a real M-A352, printed in
// the README of Epson's ess_accl_ros2_driver. Scales: data sheet table 2.3, 7.6, 7.7.
TEST_CASE("a frame with all, some or no further fields has the values of the register dump") {
    const Bytes frame =
        to_bytes({0x80, 0x8E, 0x00, 0x00, 0x00, 0x09, 0xA2, 0xFF, 0xFC, 0xE3, 0x88, 0x00,
                  0x09, 0x3A, 0x7A, 0x00, 0xFF, 0x06, 0x24, 0x07, 0xD0, 0xC4, 0x9C, 0x0D});
    const BurstValues values{
        .flag = 0x8E00, .temperature = 2466, .axes = {-203896, 604794, 16713252}, .count = 2000};
    check_both_ways(0xC703, frame, values);
    CHECK(temperature_degc(values) == Approx(25.636).margin(5e-4));
    CHECK(x_g(values, 0) == Approx(-0.012153149).margin(5e-10));
    CHECK(x_g(values, 1) == Approx(0.036048532).margin(5e-10));
    CHECK(x_g(values, 2) == Approx(0.996187449).margin(5e-10));
    const auto milligal = to_milligal(find_profile("A352AD10")->acceleration(values.axes[0]));
    CHECK(milligal.value() == Approx(-11918.2).margin(0.05));
    // The factory layout, without checksum.
    check_both_ways(0x4702, to_bytes({0x80, 0x00, 0x00, 0x09, 0xA2, 0xFF, 0xFC, 0xE3, 0x88, 0x00,
                                      0x09, 0x3A, 0x7A, 0x00, 0xFF, 0x06, 0x24, 0x00, 0x14, 0x0D}),
                    {.temperature = 2466, .axes = values.axes, .count = 20});
    check_both_ways(0x0700,
                    to_bytes({0x80, 0xFF, 0xFC, 0xE3, 0x88, 0x00, 0x09, 0x3A, 0x7A, 0x00, 0xFF,
                              0x06, 0x24, 0x0D}),
                    {.axes = values.axes});
}

// Sources of the special values: data sheet 5.13, 7.4, 7.7.
TEST_CASE("an axis at its alarm limit is 15 g, with an illegal filter 100 g, a tilt 60 degrees") {
    const BurstValues alarm{
        .flag = 0x8E10, .temperature = -1981, .axes = {0x0F000000, 0, 16760439}, .count = 40};
    check_both_ways(
        0xC703, to_bytes({0x80, 0x8E, 0x10, 0xFF, 0xFF, 0xF8, 0x43, 0x0F, 0x00, 0x00, 0x00, 0x00,
                          0x00, 0x00, 0x00, 0x00, 0xFF, 0xBE, 0x77, 0x00, 0x28, 0x54, 0xF0, 0x0D}),
        alarm);
    CHECK((alarm.flag & kFlagAlarms) != 0);
    CHECK(x_g(alarm, 0) == 15.0);
    CHECK(x_g(alarm, 2) == Approx(0.99899858).margin(5e-9));

    const BurstValues illegal{.flag = 0x8E02,
                              .temperature = -1981,
                              .axes = {0x64000000, 0x64000000, 0x64000000},
                              .count = 40};
    check_both_ways(
        0xC703, to_bytes({0x80, 0x8E, 0x02, 0xFF, 0xFF, 0xF8, 0x43, 0x64, 0x00, 0x00, 0x00, 0x64,
                          0x00, 0x00, 0x00, 0x64, 0x00, 0x00, 0x00, 0x00, 0x28, 0xB2, 0x6C, 0x0D}),
        illegal);
    CHECK((illegal.flag & kFlagAliasing) != 0);
    CHECK(x_g(illegal, 0) == 100.0);

    const BurstValues tilt{.axes = {0x2182A470, -0x2182A470, 0x0C152382}};
    check_both_ways(0x0701,
                    to_bytes({0x80, 0x21, 0x82, 0xA4, 0x70, 0xDE, 0x7D, 0x5B, 0x90, 0x0C, 0x15,
                              0x23, 0x82, 0x2F, 0x96, 0x0D}),
                    tilt);
    const int bits = find_profile("A352AD10")->tilt_fraction_bits;
    CHECK(std::ldexp(tilt.axes[0], -bits) == Approx(std::numbers::pi / 3).margin(2e-9));
    CHECK(std::ldexp(tilt.axes[1], -bits) == Approx(-std::numbers::pi / 3).margin(2e-9));
    CHECK(std::ldexp(tilt.axes[2], -bits) == Approx(0.37758041).margin(5e-9));
}

TEST_CASE("each of the 256 byte values is decoded in each position of the payload") {
    const BurstLayout layout = BurstLayout::recommended();
    const std::size_t checksum_at = layout.frame_size() - 3;
    for (std::size_t at = 1; at < checksum_at; ++at) {
        for (unsigned value = 0; value <= 0xFF; ++value) {
            CAPTURE(at, value);
            Bytes frame = frame_at(layout, 2);
            frame[at] = static_cast<std::byte>(value);
            const unsigned sum = burst_checksum(std::span(frame).subspan(1, checksum_at - 1));
            frame[checksum_at] = static_cast<std::byte>(sum >> 8);
            frame[checksum_at + 1] = static_cast<std::byte>(sum & 0xFF);

            const auto events =
                decode(layout, joined({frames(layout, 0, 2), frame, frames(layout, 3, 1)}));
            REQUIRE(events.size() == 4);
            REQUIRE(events[2].is_frame());
            REQUIRE(encode(layout.burst_ctrl(), events[2].values) == frame);
        }
    }
}

}  // namespace a351::wire
