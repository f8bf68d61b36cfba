#include "sim/oven/oven_controller.hpp"

#include "tests/support/catch.hpp"

#include "fake_oven.hpp"

using namespace a351::sim;
using namespace a351;
using namespace a351::sim::oven;
using namespace a351::sim::plant;

// Addresses, codes and ranges: Omron H175-E1 (communications manual of the E5_C), sections 4 and 5.
// The golden conversation, which modbus_server_test.cpp plays, has the usual reads, writes and
// refusals.

namespace {

using Words = std::vector<std::uint16_t>;
constexpr std::optional<Refusal> kDone;

/// A controller, its oven, and its host.
struct Desk {
    Desk() { REQUIRE(operate(0x00, 0x01) == kDone); }  // Communication writing on.

    /// Returns one register as a signed number.
    [[nodiscard]] int shown(std::uint16_t address) const {
        const auto result = controller.read(address, 1);
        REQUIRE(std::holds_alternative<Words>(result));
        return static_cast<std::int16_t>(std::get<Words>(result).at(0));
    }

    /// Returns two registers of four-byte mode as a signed number.
    [[nodiscard]] std::int32_t shown_long(std::uint16_t address) const {
        const auto result = controller.read(address, 2);
        REQUIRE(std::holds_alternative<Words>(result));
        const Words& words = std::get<Words>(result);
        return static_cast<std::int32_t>(std::uint32_t{words.at(0)} << 16 | words.at(1));
    }

    [[nodiscard]] std::optional<Refusal> read_refusal(std::uint16_t address,
                                                      std::size_t count) const {
        const auto result = controller.read(address, count);
        const Refusal* refusal = std::get_if<Refusal>(&result);
        return refusal == nullptr ? kDone : std::optional(*refusal);
    }

    std::optional<Refusal> put(std::uint16_t address, int digits) {
        const auto word = static_cast<std::uint16_t>(digits);
        return controller.write(address, std::span(&word, 1));
    }
    std::optional<Refusal> operate(std::uint8_t command, std::uint8_t parameter) {
        return controller.operate(command, parameter);
    }
    [[nodiscard]] bool has(std::uint32_t bits) const { return (controller.status() & bits) != 0; }

    FakeOven oven;
    oven::Controller controller{oven};
};

}  // namespace

TEST_CASE("both address modes show the same values, in digits of the display") {
    struct Pair {
        std::uint16_t four_byte, two_byte;
    };
    Desk desk;
    CHECK(desk.shown(0x2A00) == 50);   // Proportional band 5.0 degC
    CHECK(desk.shown(0x2A01) == 133);  // Integral time in s
    // The upper half of the status has an address of its own in two-byte mode.
    CHECK(desk.controller.status() == 0x02000100);
    CHECK(desk.shown(0x2406) == 0x0100);
    CHECK(desk.shown(0x2407) == 0x0200);
    CHECK(desk.shown_long(0x040C) == 0x02000100);
    REQUIRE(desk.operate(0x00, 0x00) == kDone);
    desk.oven.reading = DegC(-3.2);
    for (const Pair pair :
         {Pair{0x0000, 0x2000}, {0x0002, 0x2001}, {0x0004, 0x2002}, {0x0006, 0x2003},
          {0x0008, 0x2004},     {0x000A, 0x2005}, {0x0106, 0x2103}, {0x0108, 0x2104},
          {0x010A, 0x2105},     {0x010C, 0x2106}, {0x0404, 0x2402}, {0x0406, 0x2403},
          {0x0420, 0x2410},     {0x0800, 0x2800}, {0x0900, 0x2900}, {0x0A00, 0x2A00},
          {0x0A02, 0x2A01},     {0x0A04, 0x2A02}, {0x0C00, 0x2C00}, {0x0D28, 0x2D14}}) {
        CAPTURE(pair.four_byte);
        CHECK(desk.shown_long(pair.four_byte) == desk.shown(pair.two_byte));
    }
    CHECK(desk.shown(0x2000) == -32);
}

TEST_CASE("writing can be switched off again, and the lowest of several reasons to refuse is given") {
    Desk desk;
    CHECK(desk.put(0x2103, 430) == kDone);
    CHECK(desk.oven.target == DegC(43.0));
    CHECK(desk.shown(0x2002) == 430);
    CHECK(desk.operate(0x00, 0x00) == kDone);  // Communication writing is off: reason 04.
    CHECK(desk.put(0x2103, 425) == Refusal::operation);
    CHECK(desk.operate(0x01, 0x01) == Refusal::operation);
    CHECK(desk.put(0x2103, 9999) == Refusal::data);
    CHECK(desk.put(0x2099, 9999) == Refusal::address);
    CHECK(desk.operate(0x1F, 0x00) == Refusal::data);
    CHECK(desk.oven.target == DegC(43.0));
}

TEST_CASE("106 elements are read at once, and 104 written at most") {
    Desk desk;
    CHECK(desk.read_refusal(0x2000, 106) == kDone);
    CHECK(desk.read_refusal(0x2000, 107) == Refusal::data);
    CHECK(desk.read_refusal(0x0000, 106) == kDone);
    CHECK(desk.read_refusal(0x0000, 108) == Refusal::data);
    CHECK(desk.read_refusal(0x2000, 0) == Refusal::data);
    CHECK(desk.controller.write(0x2103, Words(105, 0)) == Refusal::data);
    CHECK(desk.controller.write(0x2103, Words{}) == Refusal::data);
}

TEST_CASE("several variables are written together or not at all") {
    Desk desk;
    CHECK(desk.controller.write(0x2103, Words{430, 50, 20, 10}) == kDone);
    CHECK(desk.shown(0x2103) == 430);
    CHECK(desk.shown(0x2106) == 10);
    CHECK(desk.controller.write(0x2103, Words{440, 20000}) == Refusal::data);
    CHECK(desk.controller.write(0x2103, Words(5, 100)) == Refusal::address);  // Across the end.
    CHECK(desk.shown(0x2103) == 430);
    CHECK(desk.oven.target == DegC(43.0));
}

TEST_CASE("set point, P and I reach the oven within their limits, and only if they are written") {
    Desk desk;
    desk.oven.target = DegC(42.53);
    desk.oven.pi = {5.0, 133.333};
    REQUIRE(desk.operate(0x01, 0x01) == kDone);
    desk.controller.restart();
    CHECK(desk.oven.set_point_writes == 0);
    CHECK(desk.oven.tuning_writes == 0);
    REQUIRE(desk.operate(0x00, 0x01) == kDone);
    CHECK(desk.put(0x2103, 5000) == kDone);
    CHECK(desk.put(0x2103, 5001) == Refusal::data);
    CHECK(desk.put(0x2900, -200) == kDone);
    CHECK(desk.put(0x2900, -201) == Refusal::data);
    CHECK(desk.oven.target == DegC(-20.0));
    REQUIRE(desk.controller.write(0x2A00, Words{80, 233}) == kDone);
    CHECK(desk.oven.pi.proportional_band_degc == 8.0);
    CHECK(desk.oven.pi.integral_time_s == 233.0);
    CHECK(desk.put(0x2A00, 0) == Refusal::data);
}

TEST_CASE("a broken sensor shows as an input error and as the end of the range") {
    Desk desk;
    desk.oven.break_sensor(true);
    CHECK(desk.has(oven_status::kInputError));
    CHECK_FALSE(desk.has(oven_status::kHeating));
    CHECK(desk.shown(0x2000) == 5000);
    CHECK(desk.shown(0x2402) == 5000);
    desk.oven.break_sensor(false);
    CHECK_FALSE(desk.has(oven_status::kInputError));
    CHECK(desk.shown(0x2000) == 425);
    // In setup area 1 the status bits of the sensor keep their last values.
    desk.oven.break_sensor(true);
    REQUIRE(desk.operate(0x07, 0x00) == kDone);
    desk.oven.break_sensor(false);
    CHECK(desk.has(oven_status::kInputError));
    desk.controller.restart();
    CHECK_FALSE(desk.has(oven_status::kInputError));
}

TEST_CASE("alarm 1 is raised at its distance above the set point") {
    Desk desk;
    desk.oven.reading = DegC(52.4);
    CHECK_FALSE(desk.has(oven_status::kAlarm1));
    desk.oven.reading = DegC(52.5);
    CHECK(desk.has(oven_status::kAlarm1));
}

TEST_CASE("values written to RAM only are lost in a restart") {
    Desk desk;
    CHECK(desk.operate(0x04, 0x01) == kDone);
    CHECK(desk.put(0x2103, 440) == kDone);
    CHECK(desk.oven.target == DegC(44.0));
    CHECK((desk.has(oven_status::kRamMode) && desk.has(oven_status::kRamDiffers)));

    SECTION("not saved") {
        desk.controller.restart();
        CHECK(desk.oven.target == DegC(42.5));
    }
    SECTION("saved by command") {
        CHECK(desk.operate(0x05, 0x00) == kDone);
        CHECK((desk.has(oven_status::kRamMode) && !desk.has(oven_status::kRamDiffers)));
        desk.controller.restart();
        CHECK(desk.oven.target == DegC(44.0));
    }
    SECTION("saved by the return to backup mode") {
        CHECK(desk.operate(0x04, 0x00) == kDone);
        CHECK_FALSE(desk.has(oven_status::kRamMode | oven_status::kRamDiffers));
        desk.controller.restart();
        CHECK(desk.oven.target == DegC(44.0));
    }
    CHECK_FALSE(desk.has(oven_status::kRamMode | oven_status::kRamDiffers));
}

TEST_CASE("initial settings can be written in setup area 1 only, where control is stopped") {
    Desk desk;
    CHECK(desk.put(0x2D14, 0) == Refusal::operation);
    CHECK(desk.operate(0x07, 0x00) == kDone);
    CHECK_FALSE(desk.oven.runs);
    CHECK(desk.has(oven_status::kSetupArea1));
    CHECK_FALSE(desk.has(oven_status::kStopped));
    CHECK(desk.put(0x2D14, 0) == kDone);
    CHECK(desk.oven.kind == ControllerKind::on_off);
    CHECK(desk.operate(0x03, 0x00) == Refusal::operation);
    desk.controller.restart();
    CHECK(desk.oven.runs);
    CHECK_FALSE(desk.has(oven_status::kSetupArea1));
    CHECK(desk.oven.kind == ControllerKind::on_off);
}

TEST_CASE("input type 5 shows whole degrees") {
    Desk desk;
    desk.oven.reading = DegC(42.7);
    REQUIRE(desk.operate(0x07, 0x00) == kDone);
    CHECK(desk.put(0x2C00, 7) == Refusal::data);  // J: no such couple in this oven
    REQUIRE(desk.put(0x2C00, 5) == kDone);
    CHECK(desk.shown(0x2410) == 0);
    CHECK(desk.shown(0x2000) == 43);
    CHECK(desk.controller.write(0x0106, Words{0x7FFF, 0xFFFF}) == Refusal::data);
    REQUIRE(desk.put(0x2103, 44) == kDone);
    CHECK(desk.oven.target == DegC(44.0));
    CHECK(desk.put(0x2103, 425) == kDone);  // The mistake a host must not make
    CHECK(desk.oven.target == DegC(425.0));
}

TEST_CASE("commands that this controller cannot execute are refused") {
    struct Case {
        std::uint8_t command, parameter;
        std::optional<Refusal> refusal;
    };
    Desk desk;
    for (const Case& c : {Case{0x02, 0x00, kDone},
                          {0x02, 0x01, Refusal::operation},
                          {0x02, 0x08, Refusal::data},
                          {0x03, 0x00, kDone},
                          {0x03, 0x01, Refusal::operation},
                          {0x03, 0x03, Refusal::data},
                          {0x08, 0x00, kDone},
                          {0x09, 0x00, kDone},
                          {0x09, 0x01, Refusal::operation},
                          {0x0A, 0x00, Refusal::data},
                          {0x0B, 0x00, Refusal::operation},  // Setup area 1 only.
                          {0x0C, 0x0F, kDone},
                          {0x0C, 0x06, Refusal::data},
                          {0x0D, 0x01, Refusal::operation},
                          {0x0E, 0x01, Refusal::operation},
                          {0x11, 0x01, Refusal::operation},
                          {0x01, 0x02, Refusal::data},
                          {0x05, 0x01, Refusal::data}}) {
        CAPTURE(int{c.command}, int{c.parameter});
        CHECK(desk.operate(c.command, c.parameter) == c.refusal);
    }
    CHECK(desk.controller.speaks_modbus());
}
