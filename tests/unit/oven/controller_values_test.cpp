#include "protocol/oven/controller_values.hpp"

#include <array>
#include "tests/support/catch.hpp"

namespace a351::oven {
namespace {

/// Process value, status, set point, heater current, heating: 42.5 degC, heating on, 42.5 degC,
/// 0 A, 25.0 %.  Digits by the rules of H175-E1, section 4: 42.5 degC is 01A9h, 25.0 % is 00FAh.
constexpr std::array<std::uint16_t, kMonitorCount> kWarm{0x01A9, 0x0100, 0x01A9, 0x0000, 0x00FA};

}  // namespace

TEST_CASE(
    "the five monitor registers give the numbers of the display; decimals apply to temperatures") {
    for (const auto& [decimals, expected] : {std::pair{0, 425.0}, {1, 42.5}, {2, 4.25}}) {
        const auto values = controller_values(kWarm, decimals);
        CHECK(values->process_value == DegC(expected));
        CHECK(values->set_point == DegC(expected));
        CHECK(values->heating == Percent(25.0));
        CHECK(values->status == kHeatingOutput);
    }
}

TEST_CASE("negative numbers are in two's complement") {
    const auto values =
        controller_values(std::array<std::uint16_t, 5>{0xFF9C, 0, 0xFFFF, 0, 0xFFCE}, 1);
    CHECK(values->process_value == DegC(-10.0));
    CHECK(values->set_point == DegC(-0.1));
    CHECK(values->heating == Percent(-5.0));
}

TEST_CASE("a process value with an input error is not used") {
    for (unsigned bit = 0; bit < 16; ++bit) {
        auto registers = kWarm;
        registers[1] = static_cast<std::uint16_t>(1U << bit);
        const auto values = controller_values(registers, 1);
        const bool is_error = bit == 2 || bit == 5 || bit == 6;  // H175, H159: tables of the status
        CHECK(values->process_value.has_value() == !is_error);
        CHECK(has_input_error(registers[1]) == is_error);
        CHECK(values->set_point == DegC(42.5));
        CHECK(values->status == registers[1]);
    }
}

TEST_CASE("an answer with more or fewer registers is refused") {
    CHECK_FALSE(controller_values({}, 1));
    CHECK_FALSE(controller_values(std::span(kWarm).first(4), 1));
    CHECK_FALSE(controller_values(std::array<std::uint16_t, 6>{}, 1));
}

}  // namespace a351::oven
