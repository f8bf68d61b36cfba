#include "protocol/wire/handshake.hpp"

#include "tests/support/catch.hpp"

#include "tests/unit/wire/scripted_registers.hpp"

namespace a351::wire {
namespace {

const DeviceProfile& kProfile = *find_profile("A352AD10");
constexpr const Register& kProductId1 = require_register(Window::w1, 0x6A);

HandshakeRun run_with(ScriptedRegisters& device, SensorSettings settings = {}) {
    Handshake handshake(kProfile, settings);
    return run_handshake(handshake, device);
}

bool has_written(const ScriptedRegisters& device, int address, int value) {
    return std::ranges::count(device.received, to_bytes({address, value, 0x0D})) > 0;
}

void check_sampling_as_asked(const HandshakeRun& run, const ScriptedRegisters& device) {
    REQUIRE(run.has_succeeded());
    CHECK(device.is_sampling);
    CHECK(device.get(kSmplCtrl) == 0x0600);
    CHECK((device.get(kFilterCtrl) & 0x0F) == 6);
    CHECK(device.get(kUartCtrl) == 0x0101);
    CHECK(device.get(kBurstCtrl) == 0xC703);
    CHECK((device.get(kSigCtrl) & 0x8EE0) == 0x8E00);
    CHECK((device.get(kMscCtrl) & 0xFF46) == 0x0006);
}

}  // namespace

TEST_CASE("a device with factory settings is brought to sampling with the requested settings",
          "[wire][handshake]") {
    ScriptedRegisters device;
    check_sampling_as_asked(run_with(device), device);
    CHECK(device.received.back() == to_bytes({0x83, 0x01, 0x0D}));
    CHECK(device.received[device.received.size() - 2] == to_bytes({0xFE, 0x00, 0x0D}));
}

TEST_CASE("on request each register is read before a setting is written, also one that is silent",
          "[wire][handshake]") {
    ScriptedRegisters device;
    device.unanswered[ScriptedRegisters::key(kBurstCtrl)] = 3;  // a read is tried three times
    Handshake handshake(kProfile, {});
    handshake.read_all_registers();
    check_sampling_as_asked(run_handshake(handshake, device), device);
    REQUIRE(handshake.registers().size() == kRegisters.size());
    for (std::size_t i = 0; i < kRegisters.size(); ++i) {
        const auto& [reg, value] = handshake.registers()[i];
        INFO(reg->name);
        CHECK(reg == &kRegisters[i]);
        CHECK(value.has_value() == (reg != &kBurstCtrl));
        if (value && reg->name != "WIN_CTRL" && reg->name != "MODE_CTRL")
            CHECK(*value == reg->default_value);
    }
    CHECK(handshake.identity().product_id == "A352AD10");
    CHECK(handshake.repeated_reads() == 2);
}

TEST_CASE(
    "each register of a list whose first two answers are lost is read, and repeats are counted",
    "[wire][handshake]") {
    ScriptedRegisters device;
    for (const Register& reg : kRegisters) device.unanswered[ScriptedRegisters::key(reg)] = 2;
    Handshake handshake(kProfile, {});
    handshake.read_all_registers();
    check_sampling_as_asked(run_handshake(handshake, device), device);
    REQUIRE(handshake.registers().size() == kRegisters.size());
    for (const auto& [reg, value] : handshake.registers()) {
        INFO(reg->name);
        CHECK(value.has_value());
    }
    CHECK(handshake.repeated_reads() == 2 * static_cast<int>(kRegisters.size()));
    Handshake undisturbed(kProfile, {});
    run_handshake(undisturbed, device);
    CHECK(undisturbed.repeated_reads() == 0);
}

TEST_CASE("each command is preceded by a window selection", "[wire][handshake]") {
    ScriptedRegisters device;
    device.not_ready_reads = 2;
    run_with(device);
    bool is_selected = false;
    for (const Bytes& command : device.received) {
        if (command[0] == std::byte{0xFE}) {
            is_selected = true;
        } else {
            REQUIRE(is_selected);
            // Only the two bytes of one register share a selection.
            if ((command[0] & std::byte{0x80}) == std::byte{}) is_selected = false;
        }
    }
}

TEST_CASE(
    "before the first question sampling is stopped and the line drained twice, with a lone CR "
    "between",
    "[wire][handshake]") {
    Handshake handshake(kProfile, {});
    const std::vector<Bytes> expected{to_bytes({0xFE, 0x00, 0x0D}),
                                      to_bytes({0x83, 0x02, 0x0D}),
                                      Bytes{},
                                      to_bytes({0x0D}),
                                      to_bytes({0xFE, 0x00, 0x0D}),
                                      to_bytes({0x83, 0x02, 0x0D}),
                                      Bytes{},
                                      to_bytes({0xFE, 0x00, 0x0D}),
                                      to_bytes({0x02, 0x00, 0x0D})};
    for (const Bytes& bytes : expected) {
        const HandshakeStep step = handshake.next({});
        if (bytes.empty()) {
            CHECK(std::holds_alternative<DrainUntilSilent>(step));
        } else {
            REQUIRE(std::holds_alternative<Transmit>(step));
            CHECK(std::get<Transmit>(step).bytes == bytes);
        }
    }
    CHECK(std::holds_alternative<Receive>(handshake.next({})));
}

TEST_CASE("the handshake reports the identity of the device", "[wire][handshake]") {
    ScriptedRegisters device;
    const std::vector<std::pair<int, int>> words{{0x6A, 0x3341}, {0x6C, 0x3235}, {0x6E, 0x4441},
                                                 {0x70, 0x3031}, {0x72, 0x000D}, {0x74, 0x3057},
                                                 {0x76, 0x3030}, {0x78, 0x3530}, {0x7A, 0x3130}};
    for (const auto& [address, word] : words) {
        device.values[{Window::w1, static_cast<std::uint8_t>(address)}] =
            static_cast<std::uint16_t>(word);
    }
    device.set(kDiagStat, kDiagUartOverflow);
    const auto run = run_with(device);
    REQUIRE(run.has_succeeded());
    // Product: data sheet 7.27.  Serial: a real unit, README of Epson's ess_accl_ros2_driver.
    CHECK(run.identity().product_id == "A352AD10");
    CHECK(run.identity().serial_number == "W0000501");
    CHECK(run.identity().firmware == 0x000D);
    CHECK(run.identity().diag_stat == kDiagUartOverflow);
    CHECK(run.identity().has_expected_product_id);
}

TEST_CASE("another product is reported, not refused", "[wire][handshake]") {
    ScriptedRegisters device;
    device.set(kProductId1, 0x3342);
    const auto run = run_with(device);
    REQUIRE(run.has_succeeded());
    CHECK(run.identity().product_id == "B352AD10");
    CHECK_FALSE(run.identity().has_expected_product_id);
}

TEST_CASE("a register that already has its value is not written", "[wire][handshake]") {
    ScriptedRegisters device;
    run_with(device);
    device.received.clear();
    check_sampling_as_asked(run_with(device), device);
    for (const Bytes& command : device.received) {
        const bool is_write = (command[0] & std::byte{0x80}) != std::byte{};
        CHECK((!is_write || command[0] == std::byte{0xFE} || command[0] == std::byte{0x83}));
    }
}

TEST_CASE("a device left streaming is stopped first", "[wire][handshake]") {
    ScriptedRegisters device;
    device.is_sampling = true;
    device.set(kModeCtrl, 0x0000);
    device.set(kUartCtrl, 0x0103);  // AUTO_START
    check_sampling_as_asked(run_with(device), device);
}

TEST_CASE("a half-sent command of a former host does no harm", "[wire][handshake]") {
    for (const Bytes& rest : {to_bytes({0x83}), to_bytes({0x83, 0x01}), to_bytes({0xFE, 0x01})}) {
        ScriptedRegisters device;
        device.half_sent = rest;
        check_sampling_as_asked(run_with(device), device);
    }
}

TEST_CASE("a silent line ends in a failure that names MODE_CTRL", "[wire][handshake]") {
    ScriptedRegisters device;
    device.unanswered[ScriptedRegisters::key(kModeCtrl)] = 1000;
    const auto run = run_with(device);
    REQUIRE_FALSE(run.has_succeeded());
    CHECK(run.reason() == "MODE_CTRL: expected an answer of 4 bytes, found none in 3 tries");
    CHECK(run.waited < std::chrono::seconds(1));
}

TEST_CASE("two unanswered reads are repeated, whatever the register", "[wire][handshake]") {
    for (const Register& reg : {kModeCtrl, kGlobCmd, kDiagStat, kProductId1, kSigCtrl, kMscCtrl,
                                kSmplCtrl, kFilterCtrl, kUartCtrl, kBurstCtrl, kFlag}) {
        CAPTURE(reg.name);
        ScriptedRegisters device;
        device.unanswered[ScriptedRegisters::key(reg)] = 2;
        check_sampling_as_asked(run_with(device), device);
    }
}

TEST_CASE("a register that never answers is named", "[wire][handshake]") {
    ScriptedRegisters device;
    device.unanswered[ScriptedRegisters::key(kBurstCtrl)] = 3;
    CHECK(run_with(device).reason() ==
          "BURST_CTRL: expected an answer of 4 bytes, found none in 3 tries");
    CHECK_FALSE(device.is_sampling);
}

TEST_CASE("a device without register W0:4C, or with another value there, is accepted",
          "[wire][handshake]") {
    ScriptedRegisters silent;
    silent.unanswered[ScriptedRegisters::key(kId)] = 1000;
    Handshake handshake(kProfile, {});
    check_sampling_as_asked(run_handshake(handshake, silent), silent);
    CHECK(handshake.repeated_reads() == 0);  // It costs each start one time-out, not three.
    ScriptedRegisters other;
    other.set(kId, 0x0D0D);
    check_sampling_as_asked(run_with(other), other);
}

TEST_CASE("the handshake waits for a device that is still starting up", "[wire][handshake]") {
    ScriptedRegisters device;
    device.not_ready_reads = 20;
    const auto run = run_with(device);
    check_sampling_as_asked(run, device);
    CHECK(run.waited > std::chrono::seconds(1));
}

TEST_CASE("a device that never gets ready fails after three seconds", "[wire][handshake]") {
    ScriptedRegisters device;
    device.not_ready_reads = 100'000;
    const auto run = run_with(device);
    CHECK(run.reason() ==
          "GLOB_CMD: expected 0x0000, found 0x0400 (bits compared: 0x0400): not ready after 3000 "
          "ms");
    CHECK(run.waited > std::chrono::milliseconds(2900));
    CHECK(run.waited < std::chrono::milliseconds(3600));
}

TEST_CASE("a failed start-up test is reported, and the device samples", "[wire][handshake]") {
    for (const auto& [bits, result] :
         {std::pair(0x0020, StartUpTest::hard_error), std::pair(0x0004, StartUpTest::flash_error),
          std::pair(0x0084, StartUpTest::hard_error), std::pair(0x0008, StartUpTest::passed)}) {
        CAPTURE(bits);
        ScriptedRegisters device;
        device.set(kDiagStat, static_cast<std::uint16_t>(bits));
        Handshake handshake(kProfile, {});
        check_sampling_as_asked(run_handshake(handshake, device), device);
        CHECK(handshake.start_up_test() == result);
        CHECK(device.resets == 0);
    }
}

TEST_CASE("a start-up test that failed is repeated by the next handshake, until one is passed",
          "[wire][handshake]") {
    for (const bool is_repaired : {false, true}) {
        CAPTURE(is_repaired);
        ScriptedRegisters device;  // DIAG_STAT is 0: the last handshake has read it.
        device.start_up_faults = is_repaired ? 0 : kDiagFlashError;
        device.samples_after_reset = true;
        Handshake handshake(kProfile, {}, {}, StartUpTest::hard_error);
        CHECK(handshake.start_up_test() == StartUpTest::hard_error);
        check_sampling_as_asked(run_handshake(handshake, device), device);
        CHECK(device.resets == 1);
        CHECK(handshake.start_up_test() ==
              (is_repaired ? StartUpTest::passed : StartUpTest::flash_error));
    }
}

TEST_CASE("a start-up test whose result was lost with the answer is repeated once",
          "[wire][handshake]") {
    ScriptedRegisters device;
    device.set(kDiagStat, 0x0020);
    device.start_up_faults = 0x0020;
    device.unanswered[ScriptedRegisters::key(kDiagStat)] = 1;
    Handshake handshake(kProfile, {});
    check_sampling_as_asked(run_handshake(handshake, device), device);
    CHECK(device.resets == 1);
    CHECK(handshake.start_up_test() == StartUpTest::hard_error);

    ScriptedRegisters again;  // The answer after the reset is lost too.
    again.unanswered[ScriptedRegisters::key(kDiagStat)] = 1;
    Handshake second(kProfile, {}, {}, StartUpTest::flash_error);
    check_sampling_as_asked(run_handshake(second, again), again);
    CHECK(again.resets == 1);
    CHECK(second.start_up_test() == StartUpTest::flash_error);

    ScriptedRegisters deaf;
    deaf.unanswered[ScriptedRegisters::key(kDiagStat)] = 3;
    Handshake third(kProfile, {});
    CHECK_THAT(run_handshake(third, deaf).reason(), ContainsSubstring("DIAG_STAT"));
    CHECK(third.start_up_test() == StartUpTest::unknown);
}

TEST_CASE("the result of a start-up test has a text that reads back", "[wire][handshake]") {
    for (const auto result : {StartUpTest::passed, StartUpTest::unknown, StartUpTest::flash_error,
                              StartUpTest::hard_error})
        CHECK(start_up_test_named(to_text(result)) == result);
    CHECK(start_up_test_named("") == std::nullopt);
}

TEST_CASE("a write that is lost once is repeated", "[wire][handshake]") {
    for (const Register& reg : {kSmplCtrl, kFilterCtrl, kUartCtrl, kMscCtrl}) {
        CAPTURE(reg.name);
        ScriptedRegisters device;
        device.set(kMscCtrl, 0x0000);
        device.lost_writes[ScriptedRegisters::key(reg)] = 1;
        check_sampling_as_asked(run_with(device), device);
    }
}

TEST_CASE("a register that does not take its value is named with the expected and the found value",
          "[wire][handshake]") {
    ScriptedRegisters device;
    device.lost_writes[ScriptedRegisters::key(kBurstCtrl)] = 1000;
    CHECK(run_with(device).reason() ==
          "BURST_CTRL: expected 0xC703, found 0x4702 (bits compared: 0xC703)");
    CHECK_FALSE(device.is_sampling);
}

TEST_CASE("reserved bits that read as 1 are not a mismatch", "[wire][handshake]") {
    ScriptedRegisters device;
    device.forced[ScriptedRegisters::key(kBurstCtrl)] = 0xE77F;
    device.forced[ScriptedRegisters::key(kSmplCtrl)] = 0xF6FF;
    CHECK(run_with(device).has_succeeded());
}

TEST_CASE("the handshake waits until the filter is set", "[wire][handshake]") {
    ScriptedRegisters device;
    device.filter_busy_reads = 20;
    check_sampling_as_asked(run_with(device), device);
    ScriptedRegisters stuck;
    stuck.forced[ScriptedRegisters::key(kFilterCtrl)] = 0x0026;
    CHECK(run_with(stuck).reason() ==
          "FILTER_CTRL: expected 0x0006, found 0x0026 (bits compared: 0x002F)");
}

TEST_CASE("answers full of CR are separated by their length", "[wire][handshake]") {
    ScriptedRegisters device;
    for (std::uint8_t address = 0x6A; address <= 0x7A; address += 2) {
        device.values[{Window::w1, address}] = 0x0D0D;
    }
    const auto run = run_with(device);
    check_sampling_as_asked(run, device);
    CHECK(run.identity().serial_number == "\r\r\r\r\r\r\r\r");
    CHECK(run.identity().firmware == 0x0D0D);
}

TEST_CASE("a pair of rate and filter that the device rejects is named", "[wire][handshake]") {
    ScriptedRegisters device;
    device.forced[ScriptedRegisters::key(kFlag)] = 0x0002;
    const auto run = run_with(device, {.output_rate_hz = 50, .filter_code = 8});
    CHECK(run.reason() ==
          "FLAG: expected 0x0000, found 0x0002 (bits compared: 0x0002): ALIASI_ERR, filter "
          "k512_fc60 is not allowed at 50 Hz");
    CHECK_FALSE(device.is_sampling);
}

TEST_CASE("baud rate, flash, self tests and the thermal compensation are not changed",
          "[wire][handshake]") {
    ScriptedRegisters device;
    device.set(kUartCtrl, 0x0302);
    device.set(kSigCtrl, 0x00F0);
    device.set(kMscCtrl, 0x0060);
    REQUIRE(run_with(device).has_succeeded());
    CHECK(device.get(kUartCtrl) == 0x0301);
    CHECK(device.get(kSigCtrl) == 0x8E10);
    CHECK(device.get(kMscCtrl) == 0x0026);
    for (const Bytes& command : device.received) {
        CHECK(command[0] != std::byte{0x89});
        CHECK(command[0] != std::byte{0x8A});
    }
}

TEST_CASE("sampling is not started if the window cannot be verified", "[wire][handshake]") {
    ScriptedRegisters device;
    device.forced[ScriptedRegisters::key(kWinCtrl)] = 0x0001;
    CHECK(run_with(device).reason() ==
          "WIN_CTRL: expected 0x0000, found 0x0001 (bits compared: 0x00FF)");
    CHECK_FALSE(device.is_sampling);
    CHECK_FALSE(has_written(device, 0x83, 0x01));
}

TEST_CASE("after its end the handshake repeats its last step", "[wire][handshake]") {
    ScriptedRegisters device;
    Handshake handshake(kProfile, {});
    REQUIRE(run_handshake(handshake, device).has_succeeded());
    CHECK(std::holds_alternative<Sampling>(handshake.next({})));
    CHECK(std::holds_alternative<Sampling>(handshake.next({})));
}

TEST_CASE("settings that the profile does not have are refused as an error of the caller",
          "[wire][handshake]") {
    CHECK_THROWS_AS(Handshake(kProfile, {.output_rate_hz = 60}), std::invalid_argument);
    CHECK_THROWS_AS(Handshake(kProfile, {.filter_code = 0}), std::invalid_argument);
}

TEST_CASE("the commands that stop sampling are valid in any window", "[wire][handshake]") {
    std::vector<std::byte> bytes;
    for (const Command& command : stop_sampling()) {
        bytes.insert(bytes.end(), command.begin(), command.end());
    }
    CHECK(bytes == to_bytes({0xFE, 0x00, 0x0D, 0x83, 0x02, 0x0D}));
}

}  // namespace a351::wire
