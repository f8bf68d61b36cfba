#include "protocol/wire/commands.hpp"

#include <set>
#include "tests/support/catch.hpp"

#include "tests/unit/wire/burst_stream.hpp"

namespace a351::wire {
namespace {

Bytes flat(const CommandSequence& commands) {
    Bytes bytes;
    for (const Command& command : commands) {
        bytes.insert(bytes.end(), command.begin(), command.end());
    }
    return bytes;
}

ConfigMode config() { return *ConfigMode::from_mode_ctrl(0x0400); }

}  // namespace

TEST_CASE(
    "commands are those of the data sheet's auto sampling example, with the window selected "
    "first") {
    // M-A352AD10 data sheet 8.2.3: 200 samples/s, BURST_CTRL 0x4702.
    CHECK(flat(config().write(kSmplCtrl, 0x0400, 0x0F00)) ==
          to_bytes({0xFE, 0x01, 0x0D, 0x85, 0x04, 0x0D}));
    CHECK(flat(config().write(kUartCtrl, 0x0001, 0x0003)) ==
          to_bytes({0xFE, 0x01, 0x0D, 0x88, 0x01, 0x0D}));
    CHECK(flat(config().write(kBurstCtrl, 0x4702, 0xC703)) ==
          to_bytes({0xFE, 0x01, 0x0D, 0x8D, 0x47, 0x0D, 0x8C, 0x02, 0x0D}));
    // The byte outside the mask is not changed, and reserved bits are zero.
    CHECK(flat(config().write(kMscCtrl, 0xFFFF, 0x0046)) ==
          to_bytes({0xFE, 0x01, 0x0D, 0x82, 0x66, 0x0D}));
    CHECK(flat(config().read(kFilterCtrl)) == to_bytes({0xFE, 0x01, 0x0D, 0x06, 0x00, 0x0D}));
    auto [sampling, start] = config().start_sampling();
    CHECK(flat(start) == to_bytes({0xFE, 0x00, 0x0D, 0x83, 0x01, 0x0D}));
    CHECK(flat(std::move(sampling).stop()) == to_bytes({0xFE, 0x00, 0x0D, 0x83, 0x02, 0x0D}));
    CHECK(flat(read_mode()) == to_bytes({0xFE, 0x00, 0x0D, 0x02, 0x00, 0x0D}));
}

TEST_CASE("configuration mode is recognised by MODE_STAT") {
    for (unsigned value = 0; value <= 0xFFFF; ++value) {
        const bool is_config = (value & 0x0C00) == 0x0400;
        REQUIRE(ConfigMode::from_mode_ctrl(static_cast<std::uint16_t>(value)).has_value() ==
                is_config);
    }
}

TEST_CASE("an answer may contain any value, but no other register, length or end") {
    for (unsigned value = 0; value <= 0xFFFF; ++value) {
        const Bytes answer =
            to_bytes({0x0C, static_cast<int>(value >> 8), static_cast<int>(value & 0xFF), 0x0D});
        REQUIRE(parse_answer(kBurstCtrl, answer) == value);
    }
    for (const Bytes& other :
         {to_bytes({0x04, 0x04, 0x00, 0x0D}), to_bytes({0x82, 0x04, 0x00, 0x0D}),
          to_bytes({0x02, 0x04, 0x00, 0x0A}), to_bytes({0x02, 0x04, 0x0D}),
          to_bytes({0x02, 0x04, 0x00, 0x0D, 0x0D}), Bytes{}})
        CHECK_FALSE(parse_answer(kModeCtrl, other));
}

TEST_CASE("the register map is consistent and agrees with the data sheet") {
    // Writable byte addresses: data sheet table 7.1.
    const std::set<int> writable_w0{0x00, 0x03, 0x7E};
    const std::set<int> writable_w1{0x00, 0x01, 0x02, 0x03, 0x05, 0x06, 0x08, 0x09, 0x0A,
                                    0x0C, 0x0D, 0x16, 0x18, 0x1A, 0x1B, 0x1C, 0x1E, 0x2C,
                                    0x2D, 0x2E, 0x2F, 0x30, 0x31, 0x32, 0x33, 0x34, 0x35,
                                    0x36, 0x37, 0x46, 0x47, 0x48, 0x49, 0x4A, 0x4B, 0x7E};
    std::set<int> w0;
    std::set<int> w1;
    for (const Register& reg : kRegisters) {
        CAPTURE(reg.name);
        CHECK(reg.address % 2 == 0);
        CHECK(register_at(reg.window, reg.address) == &reg);
        CHECK((!reg.is_saved_in_flash || reg.writable_bytes != 0));
        CHECK((reg.name == "BURST" || (reg.default_value & ~reg.defined_bits) == 0));
        auto& writable = reg.window == Window::w0 ? w0 : w1;
        if ((reg.writable_bytes & kLowByte) != 0) writable.insert(reg.address);
        if ((reg.writable_bytes & kHighByte) != 0) writable.insert(reg.address + 1);
    }
    CHECK(w0 == writable_w0);
    CHECK(w1 == writable_w1);
    CHECK(register_at(Window::w0, 0x0C) == nullptr);
}

}  // namespace a351::wire
