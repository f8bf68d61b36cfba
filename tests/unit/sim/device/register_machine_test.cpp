#include "sim/device/register_machine.hpp"

#include "tests/support/catch.hpp"

#include "tests/unit/sim/device/machine_script.hpp"

using namespace a351;
using namespace a351::sim::device;
using namespace std::chrono_literals;

TEST_CASE("commands are understood however the host splits their bytes",
          "[sim][register_machine]") {
    const auto commands = bytes_of("FE 01 0D 85 06 0D 04 00 0D FE 00 0D 02 00 0D");
    Bench whole;
    std::vector<std::byte> expected;
    whole.machine.receive(commands, whole.now, expected);
    REQUIRE(hex_of(expected) == "04 06 00 0D 02 04 00 0D");
    for (std::size_t cut = 0; cut <= commands.size(); ++cut) {
        Bench bench;
        std::vector<std::byte> answers;
        bench.machine.receive(std::span(commands).first(cut), bench.now, answers);
        bench.machine.receive(std::span(commands).subspan(cut), bench.now, answers);
        REQUIRE(answers == expected);
    }
}

TEST_CASE("damaged commands are skipped and the next one is understood",
          "[sim][register_machine]") {
    const std::string mode = "02 04 00 0D";
    for (const std::string damage :
         {"0D", "0D 0D 0D 0D", "FE", "FE 00", "12 34 56 78", "02 00 55"}) {
        CAPTURE(damage);
        Bench bench;
        std::vector<std::byte> answers;
        bench.machine.receive(bytes_of(damage), bench.now, answers);
        CHECK(answers.empty());
        // A lone CR twice, as hosts send it, ends whatever was half received.
        bench.machine.receive(bytes_of("0D 0D"), bench.now, answers);
        answers.clear();
        bench.machine.receive(bytes_of("02 00 0D"), bench.now, answers);
        CHECK(hex_of(answers) == mode);
    }
    for (const std::string stray : {"12", "12 34", "12 34 56"}) {  // without a CR behind
        CAPTURE(stray);
        Bench bench;
        std::vector<std::byte> answers;
        bench.machine.receive(bytes_of(stray + " 02 00 0D"), bench.now, answers);
        CHECK(hex_of(answers) == mode);
    }
}

TEST_CASE("a partial command is forgotten after 100 ms", "[sim][register_machine]") {
    Bench bench;
    std::vector<std::byte> answers;
    bench.machine.receive(bytes_of("02 00"), bench.now, answers);
    bench.machine.receive(bytes_of("0D"), bench.now + 100ms, answers);
    CHECK(hex_of(answers) == "02 04 00 0D");
    answers.clear();
    bench.machine.receive(bytes_of("02 00"), bench.now + 200ms, answers);
    bench.machine.receive(bytes_of("0D"), bench.now + 301ms, answers);
    CHECK(answers.empty());
}

TEST_CASE("identity registers have the first character in the low byte",
          "[sim][register_machine]") {
    // M-A352AD10 data sheet 7.27, 7.29: A352AD10, serial number 01234567.
    Bench bench;
    CHECK(bench.send({"FE 01", "6A 00", "6C 00", "6E 00", "70 00"}) ==
          "6A 33 41 0D 6C 32 35 0D 6E 44 41 0D 70 30 31 0D");
    CHECK(bench.send({"72 00", "74 00", "76 00", "78 00", "7A 00"}) ==
          "72 00 0D 0D 74 31 30 0D 76 33 32 0D 78 35 34 0D 7A 37 36 0D");
    bench.machine.rename({"A351AU10", "W0000501", 2});
    CHECK(bench.read("W1:6C") == "3135");
    CHECK(bench.read("W1:72") == "0002");
    CHECK(bench.read("W1:74") == "3057");
    CHECK(bench.read("W0:20") == "0000");  // No register.
}

TEST_CASE("a write changes only writable bytes, and only their defined bits",
          "[sim][register_machine]") {
    // Writable byte addresses of the data sheet, tables 7.1 to 7.30, without the commands that do
    // something at once (MODE_CTRL, GLOB_CMD, tests) and the registers that refuse reserved codes.
    Bench bench;
    CHECK(bench.send({"FE 01", "80 FF", "81 FF", "00 00"}) == "00 8E F4 0D");
    CHECK(bench.send({"82 FF", "02 00"}) == "02 00 66 0D");
    CHECK(bench.send({"84 FF", "04 00"}) == "04 04 00 0D");  // SMPL_CTRL low: not writable.
    CHECK(bench.send({"87 FF", "06 00"}) == "06 00 08 0D");  // FILTER_CTRL high: not writable.
    CHECK(bench.send({"8C FF", "8D FF", "0C 00"}) == "0C C7 03 0D");
    CHECK(bench.send({"9A 34", "9B 0A", "1A 00"}) == "1A 0A 34 0D");
    CHECK(bench.send({"9C FF", "9E FC", "1C 00", "1E 00"}) == "1C 00 03 0D 1E 00 0C 0D");
    CHECK(bench.send({"AD 01", "AC 3A", "AF E1", "AE 47", "2C 00", "2E 00"}) ==
          "2C 01 3A 0D 2E E1 47 0D");
    CHECK(bench.send({"C7 05", "C6 FB", "46 00"}) == "46 05 FB 0D");
    CHECK(bench.send({"EA FF", "EB FF", "6A 00"}) == "6A 33 41 0D");
    CHECK(bench.send({"FE 00", "8A FF", "B0 FF", "0A 00", "30 00"}) == "0A 00 00 0D 30 FF FF 0D");
}

TEST_CASE("reserved codes of rate, filter, baud, long-term filter and window are ignored",
          "[sim][register_machine]") {
    Bench bench;
    CHECK(bench.send({"FE 01", "85 00", "85 07", "04 00"}) == "04 04 00 0D");
    CHECK(bench.send({"86 00", "86 0F", "06 00"}) == "06 00 08 0D");
    CHECK(bench.send({"89 00", "08 00"}) == "08 01 00 0D");
    CHECK(bench.send({"9E 00", "9E 0D", "1E 00"}) == "1E 00 0A 0D");
    CHECK(bench.send({"FE 02", "04 00"}) == "04 04 00 0D");
}

TEST_CASE("during start-up NOT_READY is answered and nothing else", "[sim][register_machine]") {
    Bench bench;
    bench.machine.power_cycle(bench.now);
    CHECK(bench.send({"FE 00", "02 00", "FE 01", "0A 00", "85 06"}) == "0A 04 00 0D");
    bench.wait(power_on_time(*wire::find_profile("A352AD10")));
    CHECK(bench.send({"0A 00", "04 00"}) == "0A 00 00 0D 04 04 00 0D");
}

TEST_CASE("SOFT_RST reads 1 until its reset is done, and works during sampling too",
          "[sim][register_machine]") {
    Bench bench;
    bench.start_logging();
    CHECK(bench.send({"FE 01", "8A 80"}).empty());
    CHECK_FALSE(bench.machine.is_sampling());
    CHECK(bench.send({"FE 01", "0A 00"}) == "0A 04 80 0D");
    bench.wait(RegisterMachine::kResetTime);
    CHECK(bench.send({"0A 00", "04 00", "FE 00", "02 00"}) ==
          "0A 00 00 0D 04 04 00 0D 02 04 00 0D");
}

TEST_CASE("during sampling all writes except mode, reset and window are ignored",
          "[sim][register_machine]") {
    Bench bench;
    // Rate, signal, self test, flash backup, user filter; sleep only from configuration.
    CHECK(bench.send({"83 01", "83 03", "FE 01", "85 06", "80 00", "83 01", "8A 08", "96 02",
                      "04 00", "00 00", "02 00", "0A 00", "16 00"}) ==
          "04 04 00 0D 00 8E 04 0D 02 00 26 0D 0A 00 00 0D 16 00 00 0D");
    CHECK(bench.machine.is_sampling());
}

TEST_CASE("an edge at EXT wakes a sleeping device into configuration mode",
          "[sim][register_machine]") {
    Bench bench;
    CHECK(bench.send({"FE 01", "85 06", "FE 00", "83 03"}).empty());
    CHECK(bench.machine.is_asleep());
    CHECK(bench.send({"FE 01", "8A 80", "0A 00", "FE 00", "02 00"}).empty());
    CHECK(bench.sample(8).empty());
    bench.machine.external_edge(bench.now);
    CHECK_FALSE(bench.machine.is_asleep());
    CHECK(bench.send({"02 00"}).empty());
    bench.wait(RegisterMachine::kWakeTime);
    CHECK(bench.read("W0:02") == "0400");
    CHECK(bench.read("W1:04") == "0600");  // Settings are kept.
}

TEST_CASE("a power cycle wakes a sleeping device too", "[sim][register_machine]") {
    Bench bench;
    bench.send({"83 03"});
    bench.machine.power_cycle(bench.now);
    bench.wait(power_on_time(*wire::find_profile("A352AD10")));
    CHECK(bench.read("W0:02") == "0400");
}

TEST_CASE("a new baud rate applies from the end of its write", "[sim][register_machine]") {
    Bench bench;
    CHECK(bench.machine.baud() == 460800);
    bench.write("W1:89 03");
    CHECK(bench.machine.baud() == 115200);
    bench.write("W1:89 02");
    CHECK(bench.machine.baud() == 230400);
}

TEST_CASE("FILTER_STAT reads busy while a filter is being set", "[sim][register_machine]") {
    Bench bench;
    CHECK(bench.send({"FE 01", "86 06", "06 00"}) == "06 00 26 0D");
    bench.wait(RegisterMachine::kFilterTime);
    CHECK(bench.send({"06 00"}) == "06 00 06 0D");
    CHECK(bench.send({"86 0C", "06 00"}) == "06 00 2C 0D");
    bench.wait(RegisterMachine::kUserFilterTime - 4ms);
    CHECK(bench.read("W1:06") == "002C");
    CHECK(bench.read("W1:06") == "000C");
}

TEST_CASE("reading DIAG_STAT clears it and EA", "[sim][register_machine]") {
    Bench bench;
    bench.machine.raise_diagnostics(0x0020);
    CHECK(bench.read("W0:06") == "0001");
    CHECK(bench.read("W0:04") == "0020");
    CHECK(bench.read("W0:04") == "0000");
    CHECK(bench.read("W0:06") == "0000");
}

TEST_CASE(
    "settings changed from outside keep the host's window, half-sent command and command count",
    "[sim][register_machine]") {
    const std::array changes{RegisterChange{wire::kSmplCtrl, 0x0600, wire::kHighByte},
                             RegisterChange{wire::kFilterCtrl, 0x0006, wire::kFilterSelect},
                             RegisterChange{wire::kUartCtrl, 0x0300, wire::kHighByte},
                             RegisterChange{wire::kBurstCtrl, 0xC703}};
    const auto whole = bytes_of("04 00 0D");
    for (std::size_t sent = 0; sent < whole.size(); ++sent) {
        CAPTURE(sent);
        Bench bench;
        bench.machine.raise_diagnostics(0x0020);
        bench.send({"FE 01", "88 01"});
        const std::uint64_t commands = bench.machine.command_count();
        std::vector<std::byte> answers;
        bench.machine.receive(std::span(whole).first(sent), bench.now, answers);

        bench.machine.apply_settings(changes, bench.now);
        bench.machine.clear_diagnostics();
        CHECK(bench.machine.command_count() == commands);
        CHECK(bench.machine.is_sampling());
        CHECK(bench.machine.sampling_run() == 1);

        bench.machine.receive(std::span(whole).subspan(sent), bench.now, answers);
        CHECK(hex_of(answers) == "04 06 00 0D");  // SMPL_CTRL; DIAG_STAT in the other window.
        CHECK(bench.machine.command_count() == commands + 1);
        CHECK(bench.read("W1:06") == "0026");  // Busy.
        CHECK(bench.read("W1:08") == "0301");
        CHECK(bench.read("W1:0C") == "C703");
        CHECK(bench.read("W0:04") == "0000");
    }
}

TEST_CASE("settings cannot be changed from outside while the device starts up or sleeps",
          "[sim][register_machine]") {
    const std::array changes{RegisterChange{wire::kSmplCtrl, 0x0600, wire::kHighByte}};
    Bench bench;
    bench.send({"83 03"});
    bench.machine.apply_settings(changes, bench.now);
    CHECK(bench.machine.is_asleep());
    CHECK_FALSE(bench.machine.is_sampling());
    bench.machine.power_cycle(bench.now);
    bench.machine.apply_settings(changes, bench.now);
    CHECK_FALSE(bench.machine.is_sampling());
    bench.wait(power_on_time(*wire::find_profile("A352AD10")));
    CHECK(bench.read("W1:04") == "0400");
}

TEST_CASE("a faulty device shows HARD_ERR after every start-up until it is repaired",
          "[sim][register_machine]") {
    Bench bench;
    bench.machine.fail_tests(0x0060);
    for (int start = 0; start < 2; ++start) {
        bench.machine.spontaneous_reset(bench.now);
        bench.wait(RegisterMachine::kResetTime);
        CHECK(bench.read("W0:04") == "0060");
        CHECK(bench.read("W0:04") == "0000");
    }
    bench.machine.fail_tests(0);
    bench.machine.spontaneous_reset(bench.now);
    bench.wait(RegisterMachine::kResetTime);
    CHECK(bench.read("W0:04") == "0000");
}
