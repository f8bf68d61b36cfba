#include "sim/line/baud.hpp"

#include "tests/support/catch.hpp"

#include "tests/unit/sim/device/machine_script.hpp"

using namespace a351::sim;

TEST_CASE("at the same speed every byte is heard as it was sent", "[sim][baud]") {
    std::vector<std::byte> all;
    for (int value = 0; value < 256; ++value) all.push_back(static_cast<std::byte>(value));
    for (const int baud : {9600, 115200, 460800}) CHECK(as_heard(all, baud, baud) == all);
    CHECK(as_heard({}, 115200, 460800).empty());
}

TEST_CASE("a speed that is off by less than half a bit in ten makes no difference", "[sim][baud]") {
    std::vector<std::byte> all;
    for (int value = 0; value < 256; ++value) all.push_back(static_cast<std::byte>(value));
    CHECK(as_heard(all, 100000, 102000) == all);
    CHECK(as_heard(all, 102000, 100000) == all);
    CHECK(as_heard(all, 100000, 120000) != all);
}

TEST_CASE("at half the speed one byte comes of two, at twice the speed two of one", "[sim][baud]") {
    // The line: a start bit, eight low ones, a stop bit, and the same again.  At half the speed the
    // samples fall on every other of them, from the third on: the stop bit is the fourth.
    const auto slow = as_heard(bytes_of("00 00"), 2, 1);
    REQUIRE(slow.size() == 1);
    CHECK(hex_of(slow) == "08");
    // 0x00 sent at f, heard at 2 f: 18 low half bits: a start bit and eight low ones, a low stop
    // bit, and again.
    CHECK(as_heard(bytes_of("00"), 1, 2).size() == 2);
    CHECK(hex_of(as_heard(bytes_of("F0"), 1, 2)).substr(0, 2) == "00");
}

TEST_CASE("a command at the wrong speed is no command", "[sim][baud]") {
    const auto command = bytes_of("FE 01 0D 6A 00 0D");
    for (const int heard : {115200, 230400}) {
        CHECK(as_heard(command, 460800, heard) != command);
        CHECK(as_heard(command, heard, 460800) != command);
    }
}
