#include "sim/device/signal_path.hpp"

#include "tests/support/catch.hpp"

#include "tests/unit/sim/device/machine_script.hpp"

using namespace a351;
using namespace a351::sim::device;
using namespace std::chrono_literals;

namespace {

/// Writes coefficients as the maker's C driver does: data, command, poll.
void upload(Bench& bench, std::string_view hex) {
    bench.send({"FE 01", "9B 08", "9A 00"});
    for (const std::byte byte : bytes_of(hex)) {
        bench.send({"98 " + hex_of(std::span(&byte, 1)), "96 02"});
        bench.wait(UserFilter::kWriteTime);
        REQUIRE(bench.read("W1:16") == "0000");
    }
}

}  // namespace

TEST_CASE("FIR_UCMD is busy for 7 ms per byte written and 0.5 ms per byte read",
          "[sim][user_filter]") {
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

TEST_CASE("while a byte is being written, new data, addresses and commands are ignored",
          "[sim][user_filter]") {
    Bench bench;
    bench.send({"FE 01", "98 11", "96 02", "98 22", "9A 40", "96 01"});
    CHECK(bench.read("W1:16") == "0002");
    bench.wait(UserFilter::kWriteTime);
    CHECK(bench.read("W1:18") == "0011");
    CHECK(bench.read("W1:1A") == "0801");
    bench.send({"FE 01", "9A 00", "96 01"});
    CHECK(bench.read("W1:18") == "0011");
}

TEST_CASE("the address stays within 0800 to 0FFF", "[sim][user_filter]") {
    Bench bench;
    bench.send({"FE 01", "9B 07"});
    CHECK(bench.read("W1:1A") == "0800");
    bench.send({"FE 01", "9B 0F", "9A FF", "96 01"});
    CHECK(bench.read("W1:1A") == "0800");
}

TEST_CASE("a byte that cannot be read shows DATA_ERR", "[sim][user_filter]") {
    Bench bench;
    bench.machine.fail_tests(0x0004);
    bench.send({"FE 01", "96 01"});
    CHECK(bench.read("W1:18") == "8000");
}

TEST_CASE("a selected user filter multiplies a constant by the sum of its coefficients",
          "[sim][user_filter]") {
    // The maker's example of four taps: 0x20000000, a quarter each, is an average of four.  With
    // -0.75 as the last coefficient the sum is zero.
    for (const auto& [last, expected] :
         {std::pair{"00 00 00 20", "00 FF 06 24"}, {"00 00 00 A0", "00 00 00 00"}}) {
        Bench bench;
        upload(bench, "00 00 00 20 00 00 00 20 00 00 00 20 " + std::string(last));
        bench.send({"FE 01", "86 0B"});
        bench.wait(RegisterMachine::kUserFilterTime);
        bench.send({"85 06", "88 01", "8C 00", "8D 01", "FE 00", "83 01"});
        CHECK(bench.sample() == "80 " + std::string(expected) + " 0D");  // Four taps: no transient.
    }
}
