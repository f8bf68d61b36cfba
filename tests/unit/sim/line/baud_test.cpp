#include "sim/line/line.hpp"

#include "tests/support/catch.hpp"

#include "tests/unit/sim/device/machine_script.hpp"

using namespace a351;
using namespace a351::sim::device;
using namespace a351::sim::line;

TEST_CASE("at the same speed every byte is received as it was sent", "[sim][baud]") {
    std::vector<std::byte> all;
    for (int value = 0; value < 256; ++value) all.push_back(static_cast<std::byte>(value));
    for (const int baud : {9600, 115200, 460800}) CHECK(received_at_baud(all, baud, baud) == all);
    CHECK(received_at_baud({}, 115200, 460800).empty());
}

TEST_CASE("a speed error of less than half a bit in ten changes no byte", "[sim][baud]") {
    std::vector<std::byte> all;
    for (int value = 0; value < 256; ++value) all.push_back(static_cast<std::byte>(value));
    CHECK(received_at_baud(all, 100000, 102000) == all);
    CHECK(received_at_baud(all, 102000, 100000) == all);
    CHECK(received_at_baud(all, 100000, 120000) != all);
}

TEST_CASE("at half the speed two bytes are received as one, at twice the speed one byte as two",
          "[sim][baud]") {
    // Bits on the line: 0 is the start bit, 1 to 8 are low, 9 is the stop bit, then the same again.
    // At half the speed bits 3, 5, 7 and 9 become the first data bits, so the fourth one is high.
    const auto slow = received_at_baud(bytes_of("00 00"), 2, 1);
    REQUIRE(slow.size() == 1);
    CHECK(hex_of(slow) == "08");
    // 0x00 sent at f and received at 2 f is 18 low half bits: a start bit, eight low bits, a low
    // stop bit, and the same again.
    CHECK(received_at_baud(bytes_of("00"), 1, 2).size() == 2);
    CHECK(hex_of(received_at_baud(bytes_of("F0"), 1, 2)).substr(0, 2) == "00");
}

TEST_CASE("a command at the wrong speed is received as other bytes", "[sim][baud]") {
    const auto command = bytes_of("FE 01 0D 6A 00 0D");
    for (const int decoded : {115200, 230400}) {
        CHECK(received_at_baud(command, 460800, decoded) != command);
        CHECK(received_at_baud(command, decoded, 460800) != command);
    }
}
