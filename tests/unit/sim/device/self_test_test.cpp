#include "sim/device/self_test.hpp"

#include "tests/support/catch.hpp"

#include "tests/unit/sim/device/machine_script.hpp"

using namespace a351;
using namespace a351::sim::device;
using namespace std::chrono_literals;

TEST_CASE("each self test reads 1 while it runs and 0 afterwards", "[sim][self_test]") {
    struct Case {
        std::string_view command;
        std::string running;
        a351::Nanoseconds time;
    };
    for (const Case& c :
         {Case{"83 01", "0126", 200ms}, Case{"83 02", "0226", 200ms}, Case{"83 04", "0426", 200ms},
          Case{"83 07", "0726", 200ms}, Case{"83 08", "0826", 5ms}, Case{"83 10", "1026", 10s},
          Case{"83 20", "2026", 10s}, Case{"83 40", "4026", 10s}}) {
        CAPTURE(c.command);
        Bench bench;
        bench.send({"FE 01"});
        const auto started = bench.now;
        bench.send({c.command});
        bench.wait(started + c.time - 1ns - bench.now);
        CHECK(bench.send({"02 00"}) ==
              "02 " + c.running.substr(0, 2) + " " + c.running.substr(2) + " 0D");
        CHECK_FALSE(bench.machine.is_sampling());  // 83 01 in window 1 starts no sampling.
        CHECK(bench.read("W1:02") == "0026");
        CHECK(bench.read("W0:04") == "0000");
    }
}

TEST_CASE("only the self tests of acceleration, temperature and supply can run together",
          "[sim][self_test]") {
    for (const std::string_view command :
         {"83 09", "83 18", "83 30", "83 70", "83 14", "83 7F", "83 80", "83 00"}) {
        CAPTURE(command);
        Bench bench;
        bench.send({"FE 01", command});
        CHECK(bench.read("W1:02") == "0026");
    }
}

TEST_CASE("a running self test is not disturbed by another", "[sim][self_test]") {
    Bench bench;
    bench.send({"FE 01", "83 04", "83 08"});
    CHECK(bench.read("W1:02") == "0426");
}

TEST_CASE("a failure shows in DIAG_STAT only after the self test that finds it",
          "[sim][self_test]") {
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
}

TEST_CASE("the self test of the acceleration fails if its magnitude is outside 0.8 to 1.2 g",
          "[sim][self_test]") {
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

TEST_CASE("a reset ends a self test without a result", "[sim][self_test]") {
    Bench bench;
    bench.machine.fail_tests(0xF000);
    bench.send({"FE 01", "83 04", "8A 80"});
    bench.wait(RegisterMachine::kResetTime);
    CHECK(bench.read("W1:02") == "0026");
    CHECK(bench.read("W0:04") == "0000");
}
