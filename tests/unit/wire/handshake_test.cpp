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

TEST_CASE("a device in any state is brought to sampling with the requested settings") {
    ScriptedRegisters factory;
    check_sampling_as_asked(run_with(factory), factory);
    CHECK(factory.received.back() == to_bytes({0x83, 0x01, 0x0D}));
    CHECK(factory.received[factory.received.size() - 2] == to_bytes({0xFE, 0x00, 0x0D}));

    ScriptedRegisters streaming;
    streaming.is_sampling = true;
    streaming.set(kModeCtrl, 0x0000);
    streaming.set(kUartCtrl, 0x0103);  // AUTO_START
    check_sampling_as_asked(run_with(streaming), streaming);

    for (const Bytes& of_former_host :
         {to_bytes({0x83}), to_bytes({0x83, 0x01}), to_bytes({0xFE, 0x01})}) {
        ScriptedRegisters half;
        half.half_sent = of_former_host;
        check_sampling_as_asked(run_with(half), half);
    }

    ScriptedRegisters starting;
    starting.not_ready_reads = 20;
    const auto run = run_with(starting);
    check_sampling_as_asked(run, starting);
    CHECK(run.waited > std::chrono::seconds(1));

    ScriptedRegisters filtering;
    filtering.filter_busy_reads = 20;
    check_sampling_as_asked(run_with(filtering), filtering);

    ScriptedRegisters reserved;  // bits that read as 1
    reserved.forced[ScriptedRegisters::key(kBurstCtrl)] = 0xE77F;
    reserved.forced[ScriptedRegisters::key(kSmplCtrl)] = 0xF6FF;
    CHECK(run_with(reserved).has_succeeded());

    ScriptedRegisters without_id;
    without_id.unanswered[ScriptedRegisters::key(kId)] = 1000;
    Handshake handshake(kProfile, {});
    check_sampling_as_asked(run_handshake(handshake, without_id), without_id);
    CHECK(handshake.repeated_reads() == 0);  // It costs each start one time-out, not three.
    ScriptedRegisters other_id;
    other_id.set(kId, 0x0D0D);
    check_sampling_as_asked(run_with(other_id), other_id);
}

TEST_CASE("two unanswered reads and one lost write are repeated, whatever the register") {
    for (const Register& reg : {kModeCtrl, kGlobCmd, kDiagStat, kProductId1, kSigCtrl, kMscCtrl,
                                kSmplCtrl, kFilterCtrl, kUartCtrl, kBurstCtrl, kFlag}) {
        CAPTURE(reg.name);
        ScriptedRegisters device;
        device.unanswered[ScriptedRegisters::key(reg)] = 2;
        check_sampling_as_asked(run_with(device), device);
    }
    for (const Register& reg : {kSmplCtrl, kFilterCtrl, kUartCtrl, kMscCtrl}) {
        CAPTURE(reg.name);
        ScriptedRegisters device;
        device.set(kMscCtrl, 0x0000);
        device.lost_writes[ScriptedRegisters::key(reg)] = 1;
        check_sampling_as_asked(run_with(device), device);
    }
}

TEST_CASE("a handshake that fails says at which register, what it found, and samples not") {
    struct Case {
        const Register& reg;
        std::optional<std::uint16_t> forced;  // without a value the register never answers
        std::string reason;
        SensorSettings settings = {};
    };
    for (const auto& [reg, forced, reason, settings] : {
             Case{kModeCtrl, {}, "expected an answer of 4 bytes, found none in 3 tries"},
             Case{kBurstCtrl, {}, "expected an answer of 4 bytes, found none in 3 tries"},
             Case{kWinCtrl, 0x0001, "expected 0x0000, found 0x0001 (bits compared: 0x00FF)"},
             Case{kBurstCtrl, 0x4702, "expected 0xC703, found 0x4702 (bits compared: 0xC703)"},
             Case{kFilterCtrl, 0x0026, "expected 0x0006, found 0x0026 (bits compared: 0x002F)"},
             Case{kFlag,
                  0x0002,
                  "expected 0x0000, found 0x0002 (bits compared: 0x0002): ALIASI_ERR, filter "
                  "k512_fc60 is not allowed at 50 Hz",
                  {.output_rate_hz = 50, .filter_code = 8}},
         }) {
        ScriptedRegisters device;
        device.unanswered[ScriptedRegisters::key(reg)] = forced ? 0 : 1000;
        if (forced) device.forced[ScriptedRegisters::key(reg)] = *forced;
        const auto run = run_with(device, settings);
        CHECK(run.reason() == std::string(reg.name) + ": " + reason);
        CHECK_FALSE(device.is_sampling);
        if (&reg == &kModeCtrl) CHECK(run.waited < std::chrono::seconds(1));
        if (&reg == &kWinCtrl) CHECK_FALSE(has_written(device, 0x83, 0x01));
    }
    ScriptedRegisters device;
    device.not_ready_reads = 100'000;
    const auto run = run_with(device);
    CHECK(run.reason() ==
          "GLOB_CMD: expected 0x0000, found 0x0400 (bits compared: 0x0400): not ready after 3000 "
          "ms");
    CHECK(run.waited > std::chrono::milliseconds(2900));
    CHECK(run.waited < std::chrono::milliseconds(3600));

    CHECK_THROWS_AS(Handshake(kProfile, {.output_rate_hz = 60}), std::invalid_argument);
    CHECK_THROWS_AS(Handshake(kProfile, {.filter_code = 0}), std::invalid_argument);
}

TEST_CASE("on request each register is read before a setting is written, also one that is silent") {
    ScriptedRegisters device;  // A read is tried three times.
    for (const Register& reg : kRegisters) device.unanswered[ScriptedRegisters::key(reg)] = 2;
    device.unanswered[ScriptedRegisters::key(kBurstCtrl)] = 3;
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
    CHECK(handshake.repeated_reads() == 2 * static_cast<int>(kRegisters.size()));
}

TEST_CASE("each command is preceded by a window selection") {
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
    "between") {
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

TEST_CASE("the handshake reports the identity of the device") {
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

    device.set(kProductId1, 0x3342);  // Another product is reported, not refused.
    const auto other = run_with(device);
    REQUIRE(other.has_succeeded());
    CHECK(other.identity().product_id == "B352AD10");
    CHECK_FALSE(other.identity().has_expected_product_id);
}

TEST_CASE("a register that already has its value is not written") {
    ScriptedRegisters device;
    run_with(device);
    device.received.clear();
    check_sampling_as_asked(run_with(device), device);
    for (const Bytes& command : device.received) {
        const bool is_write = (command[0] & std::byte{0x80}) != std::byte{};
        CHECK((!is_write || command[0] == std::byte{0xFE} || command[0] == std::byte{0x83}));
    }
}

TEST_CASE("a failed start-up test is reported, and the device samples") {
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

TEST_CASE("a start-up test that failed is repeated by the next handshake, until one is passed") {
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

TEST_CASE(
    "a start-up test whose result was lost with the answer is repeated once; each has a text") {
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

    for (const auto result : {StartUpTest::passed, StartUpTest::unknown, StartUpTest::flash_error,
                              StartUpTest::hard_error})
        CHECK(start_up_test_named(to_text(result)) == result);
    CHECK(start_up_test_named("") == std::nullopt);
}

TEST_CASE("answers full of CR are separated by their length") {
    ScriptedRegisters device;
    for (std::uint8_t address = 0x6A; address <= 0x7A; address += 2) {
        device.values[{Window::w1, address}] = 0x0D0D;
    }
    const auto run = run_with(device);
    check_sampling_as_asked(run, device);
    CHECK(run.identity().serial_number == "\r\r\r\r\r\r\r\r");
    CHECK(run.identity().firmware == 0x0D0D);
}

TEST_CASE("baud rate, flash, self tests and the thermal compensation are not changed") {
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

TEST_CASE("after its end the handshake repeats its last step") {
    ScriptedRegisters device;
    Handshake handshake(kProfile, {});
    REQUIRE(run_handshake(handshake, device).has_succeeded());
    CHECK(std::holds_alternative<Sampling>(handshake.next({})));
    CHECK(std::holds_alternative<Sampling>(handshake.next({})));
}

}  // namespace a351::wire
