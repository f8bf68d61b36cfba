#include "sim/device/signal_path.hpp"
#include "tests/support/catch.hpp"

#include "tests/unit/sim/device/machine_script.hpp"

using namespace a351;
using namespace a351::sim::device;
using namespace std::chrono_literals;
using Kind = LongTermFilter::Kind;

TEST_CASE("the low-pass settles on a constant after twice its taps, the high-pass after its taps") {
    // Data sheet table 5.5.
    for (int log2_taps = 1; log2_taps <= 12; ++log2_taps) {
        const int taps = 1 << log2_taps;
        CAPTURE(taps);
        LongTermFilter low, high;
        low.start(Kind::low_pass, log2_taps);
        high.start(Kind::high_pass, log2_taps);
        const std::int32_t level = 4096 * 1000;
        for (int i = 1; i <= 2 * taps; ++i) {
            const auto smooth = low.next({level, -level, 0});
            const auto rest = high.next({level, -level, 0});
            REQUIRE((smooth[0] == level) == (i >= 2 * taps - 1));
            REQUIRE((rest[1] == 0) == (i >= taps));
            REQUIRE(smooth[2] == 0);
        }
    }
}

TEST_CASE("a pulse comes out of the low-pass as a triangle, and is forgotten at a restart") {
    LongTermFilter filter;
    filter.start(Kind::low_pass, 2);
    std::int32_t input = 1600;
    for (const std::int32_t value : {100, 200, 300, 400, 300, 200, 100, 0, 0}) {
        CHECK(filter.next({input, 0, 0})[0] == value);
        input = 0;
    }
    static_cast<void>(filter.next({4000, 0, 0}));
    filter.start(Kind::low_pass, 1);
    CHECK(filter.next({4, 0, 0})[0] == 1);
    filter.start(Kind::off, 1);
    CHECK(filter.next({5, 6, 7}) == std::array<std::int32_t, 3>{5, 6, 7});
}

TEST_CASE("LONGFILT_CTRL and LONGFILT_TAP act on the samples of the device") {
    Bench bench;
    bench.send(
        {"FE 01", "9C 03", "9E 02", "85 06", "86 06", "88 01", "8C 00", "8D 01", "FE 00", "83 01"});
    bench.sample(Bench::kTransient, {{0, 0, 400}, 0});
    // The high-pass of four taps: the level less 1/4, 2/4, 3/4, 4/4 of it.
    CHECK(bench.sample(5, {{0, 0, 400}, 0}) ==
          "80 00 00 01 2C 0D 80 00 00 00 C8 0D 80 00 00 00 64 0D 80 00 00 00 00 0D "
          "80 00 00 00 00 0D");
}

TEST_CASE("FIR_UCMD is busy for 7 ms per byte written and 0.5 ms per byte read") {
    Bench bench;
    bench.send({"FE 01", "98 5A"});
    const auto written = bench.now;
    bench.send({"96 02"});
    bench.wait(written + 7ms - 1ns - bench.now);
    CHECK(bench.send({"16 00"}) == "16 00 02 0D");
    CHECK(bench.send({"16 00", "1A 00"}) == "16 00 00 0D 1A 08 01 0D");
    UserFilter filter;
    std::array<std::uint8_t, 2048> memory{};
    filter.start(1, 0ns);
    filter.end_due(499us, memory, true);
    CHECK(filter.command() == 1);
    filter.end_due(500us, memory, true);
    CHECK(filter.command() == 0);
}

TEST_CASE("while a byte is being written, new data, addresses and commands are ignored") {
    Bench bench;
    bench.send({"FE 01", "98 11", "96 02", "98 22", "9A 40", "96 01"});
    CHECK(bench.read("W1:16") == "0002");
    bench.wait(UserFilter::kWriteTime);
    CHECK(bench.read("W1:18") == "0011");
    CHECK(bench.read("W1:1A") == "0801");
    bench.send({"9A 00", "96 01"});
    CHECK(bench.read("W1:18") == "0011");
    bench.machine.fail_tests(0x0004);
    bench.send({"96 01"});
    CHECK(bench.read("W1:18") == "8000");  // DATA_ERR: the byte cannot be read.
}

TEST_CASE("a selected user filter multiplies a constant by the sum of its coefficients") {
    // The maker's example of four taps: 0x20000000, a quarter each, is an average of four.  With
    // -0.75 as the last coefficient the sum is zero.
    for (const auto& [last, expected] :
         {std::pair{"00 00 00 20", "00 FF 06 24"}, {"00 00 00 A0", "00 00 00 00"}}) {
        Bench bench;
        bench.send({"FE 01", "9B 08", "9A 00"});
        for (const std::byte byte :
             bytes_of("00 00 00 20 00 00 00 20 00 00 00 20 " + std::string(last))) {
            bench.send({"98 " + hex_of(std::span(&byte, 1)), "96 02"});
            bench.wait(UserFilter::kWriteTime);
            REQUIRE(bench.read("W1:16") == "0000");
        }
        bench.send({"FE 01", "86 0B"});
        bench.wait(RegisterMachine::kUserFilterTime);
        bench.send({"85 06", "88 01", "8C 00", "8D 01", "FE 00", "83 01"});
        CHECK(bench.sample() == "80 " + std::string(expected) + " 0D");  // Four taps: no transient.
    }
}
