#include "sim/device/register_machine.hpp"

#include "tests/support/catch.hpp"

#include "tests/unit/sim/device/machine_script.hpp"

using namespace a351;
using namespace a351::sim::device;
using namespace std::chrono_literals;

TEST_CASE("commands in configuration mode are answered as the data sheet says") {
    struct Row {
        std::vector<std::string_view> commands;
        std::string_view answers;
    };
    const Row kRows[] = {
        // A write changes only writable bytes, and only their defined bits.  The writable byte
        // addresses of tables 7.1 to 7.30, without the commands that do something at once
        // (MODE_CTRL, GLOB_CMD, tests) and the registers that refuse reserved codes.
        {{"80 FF", "81 FF", "00 00"}, "00 8E F4 0D"},
        {{"82 FF", "02 00"}, "02 00 66 0D"},
        {{"84 FF", "04 00"}, "04 04 00 0D"},  // SMPL_CTRL low: not writable.
        {{"87 FF", "06 00"}, "06 00 08 0D"},  // FILTER_CTRL high: not writable.
        {{"8C FF", "8D FF", "0C 00"}, "0C C7 03 0D"},
        {{"9A 34", "9B 0A", "1A 00"}, "1A 0A 34 0D"},
        {{"9C FF", "9E FC", "1C 00", "1E 00"}, "1C 00 03 0D 1E 00 0C 0D"},
        {{"AD 01", "AC 3A", "AF E1", "AE 47", "2C 00", "2E 00"}, "2C 01 3A 0D 2E E1 47 0D"},
        {{"C7 05", "C6 FB", "46 00"}, "46 05 FB 0D"},
        {{"EA FF", "EB FF", "6A 00"}, "6A 33 41 0D"},
        {{"FE 00", "8A FF", "B0 FF", "0A 00", "30 00"}, "0A 00 00 0D 30 FF FF 0D"},
        {{"FE 00", "20 00"}, "20 00 00 0D"},  // No register.
        // Reserved codes of rate, filter, baud, long-term filter and window are ignored.
        {{"85 00", "85 07", "04 00"}, "04 04 00 0D"},
        {{"86 00", "86 0F", "06 00"}, "06 00 08 0D"},
        {{"89 00", "08 00"}, "08 01 00 0D"},
        {{"9E 00", "9E 0D", "1E 00"}, "1E 00 0A 0D"},
        {{"FE 02", "04 00"}, "04 04 00 0D"},
        // The long-term filter and 1000 samples a second exclude each other.
        {{"9C 01", "85 02", "04 00"}, "04 04 00 0D"},
        {{"85 02", "9C 01", "04 00", "1C 00"}, "04 02 00 0D 1C 00 00 0D"},
        // The address of the user filter stays within 0800 to 0FFF.
        {{"9B 07", "1A 00"}, "1A 08 00 0D"},
        {{"9B 0F", "9A FF", "96 01", "1A 00"}, "1A 08 00 0D"},
        // Only the self tests of acceleration, temperature and supply run together.
        {{"83 09", "83 18", "83 30", "83 70", "83 14", "83 7F", "83 80", "83 00", "02 00"},
         "02 00 26 0D"},
        // A running self test is not disturbed by another.
        {{"83 04", "83 08", "02 00"}, "02 04 26 0D"},
    };
    for (const Row& row : kRows) {
        CAPTURE(row.commands.front());
        Bench bench;
        bench.send({"FE 01"});
        CHECK(bench.send(row.commands) == row.answers);
    }
}

TEST_CASE("commands are understood however the host splits their bytes") {
    const auto commands = bytes_of("FE 01 0D 85 06 0D 04 00 0D FE 00 0D 02 00 0D");
    for (std::size_t cut = 0; cut <= commands.size(); ++cut) {
        Bench bench;
        std::vector<std::byte> answers;
        bench.machine.receive(std::span(commands).first(cut), bench.now, answers);
        bench.machine.receive(std::span(commands).subspan(cut), bench.now, answers);
        REQUIRE(hex_of(answers) == "04 06 00 0D 02 04 00 0D");
    }
}

TEST_CASE("damaged commands are skipped and the next one is understood") {
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

TEST_CASE("a partial command is forgotten after 100 ms") {
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

TEST_CASE("a renamed unit has the first character of its identity in the low byte") {
    Bench bench;
    bench.machine.rename({"A351AU10", "W0000501", 2});
    CHECK(bench.send({"FE 01", "6A 00", "6C 00", "72 00", "74 00", "7A 00"}) ==
          "6A 33 41 0D 6C 31 35 0D 72 00 02 0D 74 30 57 0D 7A 31 30 0D");
}

TEST_CASE("during start-up NOT_READY is answered and nothing else, and a reset also ends sampling") {
    Bench bench;
    bench.machine.power_cycle(bench.now);
    CHECK(bench.send({"FE 00", "02 00", "FE 01", "0A 00", "85 06"}) == "0A 04 00 0D");
    bench.wait(power_on_time(*wire::find_profile("A352AD10")));
    CHECK(bench.send({"0A 00", "04 00"}) == "0A 00 00 0D 04 04 00 0D");
    bench.start_logging();
    CHECK(bench.send({"FE 01", "8A 80"}).empty());
    CHECK_FALSE(bench.machine.is_sampling());
    CHECK(bench.send({"FE 01", "0A 00"}) == "0A 04 80 0D");  // SOFT_RST reads 1.
    bench.wait(RegisterMachine::kResetTime);
    CHECK(bench.send({"0A 00", "04 00", "FE 00", "02 00"}) ==
          "0A 00 00 0D 04 04 00 0D 02 04 00 0D");
}

TEST_CASE("during sampling all writes except mode, reset and window are ignored") {
    Bench bench;
    // Rate, signal, self test, flash backup, user filter; sleep only from configuration.
    CHECK(bench.send({"83 01", "83 03", "FE 01", "85 06", "80 00", "83 01", "8A 08", "96 02",
                      "04 00", "00 00", "02 00", "0A 00", "16 00"}) ==
          "04 04 00 0D 00 8E 04 0D 02 00 26 0D 0A 00 00 0D 16 00 00 0D");
    CHECK(bench.machine.is_sampling());
}

TEST_CASE("an edge at EXT or a power cycle wakes a sleeping device into configuration mode") {
    const bool by_edge = GENERATE(true, false);
    Bench bench;
    CHECK(bench.send({"FE 01", "85 06", "FE 00", "83 03"}).empty());
    CHECK(bench.machine.is_asleep());
    CHECK(bench.send({"FE 01", "8A 80", "0A 00", "FE 00", "02 00"}).empty());
    CHECK(bench.sample(8).empty());
    if (by_edge) {
        bench.machine.external_edge(bench.now);
        CHECK_FALSE(bench.machine.is_asleep());
        CHECK(bench.send({"02 00"}).empty());
        bench.wait(RegisterMachine::kWakeTime);
    } else {
        bench.power_cycle();
    }
    CHECK(bench.read("W0:02") == "0400");
    CHECK(bench.read("W1:04") == (by_edge ? "0600" : "0400"));  // An edge keeps the settings.
}

TEST_CASE("FILTER_STAT reads busy while a filter is being set") {
    Bench bench;
    CHECK(bench.send({"FE 01", "86 06", "06 00"}) == "06 00 26 0D");
    bench.wait(RegisterMachine::kFilterTime);
    CHECK(bench.send({"06 00"}) == "06 00 06 0D");
    CHECK(bench.send({"86 0C", "06 00"}) == "06 00 2C 0D");
    bench.wait(RegisterMachine::kUserFilterTime - 4ms);
    CHECK(bench.read("W1:06") == "002C");
    CHECK(bench.read("W1:06") == "000C");
}

TEST_CASE(
    "settings changed from outside keep the host's window, half-sent command and command count") {
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
        CHECK(bench.machine.baud() == 115200);

        bench.machine.receive(std::span(whole).subspan(sent), bench.now, answers);
        CHECK(hex_of(answers) == "04 06 00 0D");  // SMPL_CTRL; DIAG_STAT in the other window.
        CHECK(bench.machine.command_count() == commands + 1);
        CHECK(bench.read("W1:06") == "0026");  // Busy.
        CHECK(bench.read("W1:08") == "0301");
        CHECK(bench.read("W1:0C") == "C703");
        CHECK(bench.read("W0:04") == "0000");
    }
}

TEST_CASE("settings cannot be changed from outside while the device starts up or sleeps") {
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

TEST_CASE("a faulty device shows HARD_ERR and EA after every start-up until it is repaired") {
    Bench bench;
    bench.machine.fail_tests(0x0060);
    for (int start = 0; start < 2; ++start) {
        bench.reset();
        CHECK(bench.read("W0:06") == "0001");
        CHECK(bench.read("W0:04") == "0060");  // Reading DIAG_STAT clears it and EA.
        CHECK(bench.read("W0:04") == "0000");
        CHECK(bench.read("W0:06") == "0000");
    }
    bench.machine.fail_tests(0);
    bench.reset();
    CHECK(bench.read("W0:04") == "0000");
}

TEST_CASE("each self test reads 1 while it runs and 0 afterwards") {
    struct Case {
        std::string_view command;
        std::string_view running;
        Nanoseconds time;
    };
    for (const Case& c : {Case{"83 01", "02 01 26 0D", 200ms}, Case{"83 02", "02 02 26 0D", 200ms},
                          Case{"83 04", "02 04 26 0D", 200ms}, Case{"83 07", "02 07 26 0D", 200ms},
                          Case{"83 08", "02 08 26 0D", 5ms}, Case{"83 10", "02 10 26 0D", 10s},
                          Case{"83 20", "02 20 26 0D", 10s}, Case{"83 40", "02 40 26 0D", 10s}}) {
        CAPTURE(c.command);
        Bench bench;
        bench.send({"FE 01"});
        const auto started = bench.now;
        bench.send({c.command});
        bench.wait(started + c.time - 1ns - bench.now);
        CHECK(bench.send({"02 00"}) == c.running);
        CHECK_FALSE(bench.machine.is_sampling());  // 83 01 in window 1 starts no sampling.
        CHECK(bench.read("W1:02") == "0026");
        CHECK(bench.read("W0:04") == "0000");
    }
}

TEST_CASE("a failure shows in DIAG_STAT only after the self test that finds it") {
    struct Case {
        std::string_view command, shown;
    };
    for (const Case c : {Case{"83 04", "F002"}, Case{"83 02", "0200"}, Case{"83 01", "0100"},
                         Case{"83 08", "0004"}, Case{"83 20", "0400"}, Case{"83 07", "F302"}}) {
        CAPTURE(c.command);
        Bench bench;
        bench.machine.fail_tests(0xF705);
        bench.send({"FE 01", c.command});
        CHECK(bench.read("W0:04") == "0000");
        bench.wait(SelfTest::kSensitivityTestTime);
        CHECK(bench.read("W0:06") == "0001");
        CHECK(bench.read("W0:04") == c.shown);
    }
    Bench bench;  // A reset ends a self test without a result.
    bench.machine.fail_tests(0xF000);
    bench.send({"FE 01", "83 04", "8A 80"});
    bench.wait(RegisterMachine::kResetTime);
    CHECK(bench.read("W1:02") == "0026");
    CHECK(bench.read("W0:04") == "0000");
}

TEST_CASE("the self test of the acceleration fails if its magnitude is outside 0.8 to 1.2 g") {
    struct Case {
        std::int32_t z;
        std::string_view shown;
    };
    for (const Case c : {Case{kOneG, "0000"}, Case{-kOneG, "0000"}, Case{kOneG / 10 * 7, "8002"},
                         Case{kOneG / 10 * 13, "8002"}, Case{0, "8002"}}) {
        CAPTURE(c.z);
        Bench bench;
        bench.sample(1, {{0, 0, c.z}, 0});
        bench.send({"FE 01", "83 04"});
        bench.wait(SelfTest::kShortTestTime);
        CHECK(bench.read("W0:04") == c.shown);
    }
}
