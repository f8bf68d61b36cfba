#include "sim/oven/oven_controller.hpp"

#include "tests/support/catch.hpp"

#include "fake_oven.hpp"

using namespace a351::sim;
using namespace a351;
using namespace a351::sim::oven;
using namespace a351::sim::plant;

// Addresses, codes and ranges: Omron H175-E1 (communications manual of the E5_C), sections 4 and 5.

namespace {

using Words = std::vector<std::uint16_t>;

/// Returns one register as a signed number.
int shown(const oven::Controller& controller, std::uint16_t address) {
    const auto result = controller.read(address, 1);
    REQUIRE(std::holds_alternative<Words>(result));
    return static_cast<std::int16_t>(std::get<Words>(result).at(0));
}

/// Returns two registers of four-byte mode as a signed number.
std::int32_t shown_long(const oven::Controller& controller, std::uint16_t address) {
    const auto result = controller.read(address, 2);
    REQUIRE(std::holds_alternative<Words>(result));
    const Words& words = std::get<Words>(result);
    return static_cast<std::int32_t>(std::uint32_t{words.at(0)} << 16 | words.at(1));
}

std::optional<Refusal> put(oven::Controller& controller, std::uint16_t address, int digits) {
    const auto word = static_cast<std::uint16_t>(digits);
    return controller.write(address, std::span(&word, 1));
}

std::optional<Refusal> read_refusal(const oven::Controller& controller, std::uint16_t address,
                                    std::size_t count) {
    const auto result = controller.read(address, count);
    const Refusal* refusal = std::get_if<Refusal>(&result);
    return refusal == nullptr ? std::nullopt : std::optional(*refusal);
}

void enable_writing(oven::Controller& controller) {
    REQUIRE(controller.operate(0x00, 0x01) == std::nullopt);
}

}  // namespace

TEST_CASE("both address modes show the same values", "[sim][oven_controller]") {
    struct Pair {
        std::uint16_t four_byte, two_byte;
    };
    FakeOven oven;
    oven.reading = DegC(-3.2);
    oven::Controller controller(oven);
    for (const Pair pair :
         {Pair{0x0000, 0x2000}, {0x0002, 0x2001}, {0x0004, 0x2002}, {0x0006, 0x2003},
          {0x0008, 0x2004},     {0x000A, 0x2005}, {0x0106, 0x2103}, {0x0108, 0x2104},
          {0x010A, 0x2105},     {0x010C, 0x2106}, {0x0404, 0x2402}, {0x0406, 0x2403},
          {0x0420, 0x2410},     {0x0800, 0x2800}, {0x0900, 0x2900}, {0x0A00, 0x2A00},
          {0x0A02, 0x2A01},     {0x0A04, 0x2A02}, {0x0C00, 0x2C00}, {0x0D28, 0x2D14}}) {
        CAPTURE(pair.four_byte);
        CHECK(shown_long(controller, pair.four_byte) == shown(controller, pair.two_byte));
    }
    CHECK(shown(controller, 0x2000) == -32);
}

TEST_CASE("values are whole numbers of the display's last digit", "[sim][oven_controller]") {
    FakeOven oven;
    const oven::Controller controller(oven);
    CHECK(shown(controller, 0x2000) == 425);
    CHECK(shown(controller, 0x2103) == 425);
    CHECK(shown(controller, 0x2004) == 250);
    CHECK(shown(controller, 0x2410) == 1);
    CHECK(shown(controller, 0x2A00) == 50);   // Proportional band 5.0 degC
    CHECK(shown(controller, 0x2A01) == 133);  // Integral time in s
}

TEST_CASE("the upper half of the status has an address of its own in two-byte mode",
          "[sim][oven_controller]") {
    FakeOven oven;
    oven::Controller controller(oven);
    enable_writing(controller);
    CHECK(controller.status() == 0x02000100);
    CHECK(shown(controller, 0x2001) == 0x0100);
    CHECK(shown(controller, 0x2406) == 0x0100);
    CHECK(shown(controller, 0x2407) == 0x0200);
    CHECK(shown_long(controller, 0x040C) == 0x02000100);
}

TEST_CASE("nothing is written before communication writing is on", "[sim][oven_controller]") {
    FakeOven oven;
    oven::Controller controller(oven);
    CHECK(put(controller, 0x2103, 430) == Refusal::operation);
    CHECK(controller.operate(0x01, 0x01) == Refusal::operation);
    enable_writing(controller);
    CHECK(put(controller, 0x2103, 430) == std::nullopt);
    CHECK(oven.target == DegC(43.0));
    CHECK(shown(controller, 0x2002) == 430);
    CHECK(controller.operate(0x00, 0x00) == std::nullopt);
    CHECK(put(controller, 0x2103, 425) == Refusal::operation);
    CHECK(oven.target == DegC(43.0));
}

TEST_CASE("if there are several reasons to refuse, the lowest code is given",
          "[sim][oven_controller]") {
    FakeOven oven;
    oven::Controller controller(oven);  // Communication writing is off throughout: reason 04.
    CHECK(put(controller, 0x2103, 425) == Refusal::operation);
    CHECK(put(controller, 0x2103, 9999) == Refusal::data);
    CHECK(put(controller, 0x2099, 9999) == Refusal::address);
    CHECK(controller.operate(0x1F, 0x00) == Refusal::data);
}

TEST_CASE("an address that does not exist or is read-only is refused as an address",
          "[sim][oven_controller]") {
    FakeOven oven;
    oven::Controller controller(oven);
    enable_writing(controller);
    CHECK(read_refusal(controller, 0x2006, 1) == Refusal::address);
    CHECK(read_refusal(controller, 0x0001, 2) == Refusal::address);
    CHECK(read_refusal(controller, 0x0000, 1) == Refusal::address);
    CHECK(put(controller, 0x2000, 1) == Refusal::address);  // Read only
    const Words across_the_end(5, 100);
    CHECK(controller.write(0x2103, across_the_end) == Refusal::address);
}

TEST_CASE("106 elements are read at once, and 104 written at most", "[sim][oven_controller]") {
    FakeOven oven;
    oven::Controller controller(oven);
    enable_writing(controller);
    CHECK(read_refusal(controller, 0x2000, 106) == std::nullopt);
    CHECK(read_refusal(controller, 0x2000, 107) == Refusal::data);
    CHECK(read_refusal(controller, 0x0000, 106) == std::nullopt);
    CHECK(read_refusal(controller, 0x0000, 108) == Refusal::data);
    CHECK(read_refusal(controller, 0x2000, 0) == Refusal::data);
    CHECK(controller.write(0x2103, Words(105, 0)) == Refusal::data);
    CHECK(controller.write(0x2103, Words{}) == Refusal::data);
}

TEST_CASE("several variables are written together or not at all", "[sim][oven_controller]") {
    FakeOven oven;
    oven::Controller controller(oven);
    enable_writing(controller);
    CHECK(controller.write(0x2103, Words{430, 50, 20, 10}) == std::nullopt);
    CHECK(shown(controller, 0x2103) == 430);
    CHECK(shown(controller, 0x2106) == 10);
    CHECK(controller.write(0x2103, Words{440, 20000}) == Refusal::data);
    CHECK(shown(controller, 0x2103) == 430);
    CHECK(oven.target == DegC(43.0));
}

TEST_CASE("the set point stays within its limits", "[sim][oven_controller]") {
    FakeOven oven;
    oven::Controller controller(oven);
    enable_writing(controller);
    CHECK(put(controller, 0x2103, 5000) == std::nullopt);
    CHECK(put(controller, 0x2103, 5001) == Refusal::data);
    CHECK(put(controller, 0x2900, -200) == std::nullopt);
    CHECK(put(controller, 0x2900, -201) == Refusal::data);
    CHECK(oven.target == DegC(-20.0));
}

TEST_CASE("a stopped controller does not heat the oven", "[sim][oven_controller]") {
    FakeOven oven;
    oven::Controller controller(oven);
    enable_writing(controller);
    CHECK(controller.operate(0x01, 0x01) == std::nullopt);
    CHECK_FALSE(oven.runs);
    CHECK((controller.status() & oven_status::kStopped) != 0);
    CHECK((controller.status() & oven_status::kHeating) == 0);
    CHECK(controller.operate(0x01, 0x00) == std::nullopt);
    CHECK(oven.runs);
    CHECK((controller.status() & oven_status::kStopped) == 0);
}

TEST_CASE("a broken sensor shows as an input error and as the end of the range",
          "[sim][oven_controller]") {
    FakeOven oven;
    const oven::Controller controller(oven);
    oven.break_sensor(true);
    CHECK((controller.status() & oven_status::kInputError) != 0);
    CHECK((controller.status() & oven_status::kHeating) == 0);
    CHECK(shown(controller, 0x2000) == 5000);
    CHECK(shown(controller, 0x2402) == 5000);
    oven.break_sensor(false);
    CHECK((controller.status() & oven_status::kInputError) == 0);
    CHECK(shown(controller, 0x2000) == 425);
}

TEST_CASE("alarm 1 is raised at its distance above the set point", "[sim][oven_controller]") {
    FakeOven oven;
    const oven::Controller controller(oven);
    oven.reading = DegC(52.4);
    CHECK((controller.status() & oven_status::kAlarm1) == 0);
    oven.reading = DegC(52.5);
    CHECK((controller.status() & oven_status::kAlarm1) != 0);
}

TEST_CASE("values written to RAM only are lost in a restart", "[sim][oven_controller]") {
    FakeOven oven;
    oven::Controller controller(oven);
    enable_writing(controller);
    CHECK(controller.operate(0x04, 0x01) == std::nullopt);
    CHECK(put(controller, 0x2103, 440) == std::nullopt);
    CHECK(oven.target == DegC(44.0));
    const std::uint32_t both = oven_status::kRamMode | oven_status::kRamDiffers;
    CHECK((controller.status() & both) == both);

    SECTION("not saved") {
        controller.restart();
        CHECK(oven.target == DegC(42.5));
    }
    SECTION("saved by command") {
        CHECK(controller.operate(0x05, 0x00) == std::nullopt);
        CHECK((controller.status() & both) == oven_status::kRamMode);
        controller.restart();
        CHECK(oven.target == DegC(44.0));
    }
    SECTION("saved by the return to backup mode") {
        CHECK(controller.operate(0x04, 0x00) == std::nullopt);
        CHECK((controller.status() & both) == 0);
        controller.restart();
        CHECK(oven.target == DegC(44.0));
    }
    CHECK((controller.status() & both) == 0);
}

TEST_CASE("initial settings can be written in setup area 1 only, where control is stopped",
          "[sim][oven_controller]") {
    FakeOven oven;
    oven::Controller controller(oven);
    enable_writing(controller);
    CHECK(put(controller, 0x2D14, 0) == Refusal::operation);
    CHECK(controller.operate(0x07, 0x00) == std::nullopt);
    CHECK_FALSE(oven.runs);
    CHECK((controller.status() & oven_status::kSetupArea1) != 0);
    CHECK((controller.status() & oven_status::kStopped) == 0);
    CHECK(put(controller, 0x2D14, 0) == std::nullopt);
    CHECK(oven.kind == ControllerKind::on_off);
    CHECK(controller.operate(0x03, 0x00) == Refusal::operation);
    controller.restart();
    CHECK(oven.runs);
    CHECK((controller.status() & oven_status::kSetupArea1) == 0);
    CHECK(oven.kind == ControllerKind::on_off);
}

TEST_CASE("in setup area 1 the status bits of the sensor keep their last values",
          "[sim][oven_controller]") {
    FakeOven oven;
    oven::Controller controller(oven);
    enable_writing(controller);
    oven.break_sensor(true);
    REQUIRE(controller.operate(0x07, 0x00) == std::nullopt);
    oven.break_sensor(false);
    CHECK((controller.status() & oven_status::kInputError) != 0);
    controller.restart();
    CHECK((controller.status() & oven_status::kInputError) == 0);
}

TEST_CASE("input type 5 shows whole degrees", "[sim][oven_controller]") {
    FakeOven oven;
    oven.reading = DegC(42.7);
    oven::Controller controller(oven);
    enable_writing(controller);
    REQUIRE(controller.operate(0x07, 0x00) == std::nullopt);
    CHECK(put(controller, 0x2C00, 7) == Refusal::data);  // J: no such couple in this oven
    REQUIRE(put(controller, 0x2C00, 5) == std::nullopt);
    CHECK(shown(controller, 0x2410) == 0);
    CHECK(shown(controller, 0x2000) == 43);
    CHECK(controller.write(0x0106, Words{0x7FFF, 0xFFFF}) == Refusal::data);
    REQUIRE(put(controller, 0x2103, 44) == std::nullopt);
    CHECK(oven.target == DegC(44.0));
    CHECK(put(controller, 0x2103, 425) == std::nullopt);  // The mistake a host must not make
    CHECK(oven.target == DegC(425.0));
}

TEST_CASE("the settings of P and I reach the oven", "[sim][oven_controller]") {
    FakeOven oven;
    oven::Controller controller(oven);
    enable_writing(controller);
    REQUIRE(controller.write(0x2A00, Words{80, 233}) == std::nullopt);
    CHECK(oven.pi.proportional_band_degc == 8.0);
    CHECK(oven.pi.integral_time_s == 233.0);
    CHECK(put(controller, 0x2A00, 0) == Refusal::data);
}

TEST_CASE("set point and tuning that are not written stay unchanged", "[sim][oven_controller]") {
    FakeOven oven;
    oven.target = DegC(42.53);
    oven.pi = {5.0, 133.333};
    oven::Controller controller(oven);
    enable_writing(controller);
    REQUIRE(controller.operate(0x01, 0x01) == std::nullopt);
    controller.restart();
    CHECK(oven.set_point_writes == 0);
    CHECK(oven.tuning_writes == 0);
}

TEST_CASE("initialising the parameters ends the Modbus communication", "[sim][oven_controller]") {
    FakeOven oven;
    oven::Controller controller(oven);
    enable_writing(controller);
    CHECK(controller.operate(0x0B, 0x00) == Refusal::operation);  // Setup area 1 only
    CHECK(controller.speaks_modbus());
    REQUIRE(controller.operate(0x07, 0x00) == std::nullopt);
    CHECK(controller.operate(0x0B, 0x00) == std::nullopt);
    CHECK_FALSE(controller.speaks_modbus());
}

TEST_CASE("commands that this controller cannot execute are refused", "[sim][oven_controller]") {
    struct Case {
        std::uint8_t command, parameter;
        std::optional<Refusal> refusal;
    };
    FakeOven oven;
    oven::Controller controller(oven);
    enable_writing(controller);
    for (const Case& c : {Case{0x02, 0x00, std::nullopt},
                          {0x02, 0x01, Refusal::operation},
                          {0x02, 0x08, Refusal::data},
                          {0x03, 0x00, std::nullopt},
                          {0x03, 0x01, Refusal::operation},
                          {0x03, 0x03, Refusal::data},
                          {0x08, 0x00, std::nullopt},
                          {0x09, 0x00, std::nullopt},
                          {0x09, 0x01, Refusal::operation},
                          {0x0A, 0x00, Refusal::data},
                          {0x0C, 0x0F, std::nullopt},
                          {0x0C, 0x06, Refusal::data},
                          {0x0D, 0x01, Refusal::operation},
                          {0x0E, 0x01, Refusal::operation},
                          {0x11, 0x01, Refusal::operation},
                          {0x01, 0x02, Refusal::data},
                          {0x05, 0x01, Refusal::data}}) {
        CAPTURE(int{c.command}, int{c.parameter});
        CHECK(controller.operate(c.command, c.parameter) == c.refusal);
    }
}
