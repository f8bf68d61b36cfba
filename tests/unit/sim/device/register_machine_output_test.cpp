#include <cmath>
#include "tests/support/catch.hpp"

#include "sim/device/signal_path.hpp"
#include "tests/unit/sim/device/machine_script.hpp"

using namespace a351;
using namespace a351::sim::device;
using namespace a351::sim::signal;

namespace {

/// Streams one frame of X, Y, Z and FLAG after `settings` were written in window 1.
std::string frame_with(Bench& bench, std::initializer_list<std::string_view> settings,
                       const SensorSample& sample) {
    for (const std::string_view command : settings) bench.send({"FE 01", command});
    bench.send({"FE 01", "85 06", "86 06", "88 01", "8C 00", "8D 87", "FE 00", "83 01"});
    bench.sample(Bench::kTransient, SensorSample{});
    return bench.sample(1, sample);
}

}  // namespace

TEST_CASE("an offset is added to its axis", "[sim][register_machine]") {
    // Data sheet 8.2: +1.23 g on X is 013AE147.
    Bench bench;
    const SensorSample sample{{kOneG, kOneG, kOneG}, 0};
    CHECK(frame_with(bench, {"AD 01", "AC 3A", "AF E1", "AE 47"}, sample) ==
          "80 8E 00 02 3A E1 47 01 00 00 00 01 00 00 00 0D");
    Bench other;
    CHECK(frame_with(other, {"B1 FF", "B0 FF", "B3 FF", "B2 FF", "B5 FF"}, sample) ==
          "80 8E 00 01 00 00 00 00 FF FF FF 00 00 00 00 0D");
}

TEST_CASE("beyond an alarm limit the output is the limit, and the alarm flag is set",
          "[sim][register_machine]") {
    Bench bench;
    // Factory limits: 15 g.  A value at the limit is not beyond it.
    CHECK(frame_with(bench, {}, {{15 * kOneG + 1, -15 * kOneG - 1, 15 * kOneG}, 0}) ==
          "80 8E 18 0F 00 00 00 F1 00 00 00 0F 00 00 00 0D");
    Bench other;  // Data sheet 8.2: X within 5 g.
    CHECK(frame_with(other, {"C7 05", "C6 FB"}, {{6 * kOneG, 6 * kOneG, -6 * kOneG}, 0}) ==
          "80 8E 10 05 00 00 00 06 00 00 00 FA 00 00 00 0D");
}

TEST_CASE("an alarm stays until FLAG is read, by command or by a frame that carries it",
          "[sim][register_machine]") {
    Bench bench;
    const SensorSample shaken{{0, 0, 20 * kOneG}, 0};
    const SensorSample calm{{0, 0, kOneG}, 0};
    bench.send({"FE 01", "85 06", "86 06", "8C 00", "8D 01", "FE 00", "83 01"});
    bench.sample(Bench::kTransient + 1, shaken);
    bench.sample(5, calm);
    CHECK(bench.send({"80 00"}) == "80 01 00 00 00 0D");  // No FLAG in this frame.
    CHECK((std::stoi(bench.read("W0:06"), nullptr, 16) & 0x1C) == 0x04);
    CHECK((std::stoi(bench.read("W0:06"), nullptr, 16) & 0x1C) == 0);
    Bench streaming;
    CHECK(frame_with(streaming, {}, shaken).substr(0, 8) == "80 8E 04");
    CHECK(streaming.sample(1, calm).substr(0, 8) == "80 8E 00");
}

TEST_CASE("a frame without FLAG shows no alarm, and the alarm remains until FLAG is read",
          "[sim][register_machine]") {
    Bench bench;
    const SensorSample shaken{{0, 0, 20 * kOneG}, 0};
    bench.send({"FE 01", "85 06", "86 06", "88 01", "8C 03", "8D 47", "FE 00", "83 01"});
    bench.sample(Bench::kTransient);
    std::vector<std::byte> frames;
    for (int i = 0; i < 3; ++i) {
        const auto values = bench.machine.sample(shaken, frames);
        REQUIRE(values);
        CHECK(values->flag == 0);
    }
    CHECK((std::stoi(bench.read("W0:06"), nullptr, 16) & 0x1C) == 0x04);
    CHECK((std::stoi(bench.read("W0:06"), nullptr, 16) & 0x1C) == 0);
}

TEST_CASE("tilt is the arc sine of the acceleration, in radians times 2^29",
          "[sim][register_machine]") {
    const auto& profile = *wire::find_profile("A352AD10");
    for (int i = -86; i <= 86; ++i) {  // sin 60 degrees is 0.866.
        const auto counts = static_cast<std::int32_t>(i * (kOneG / 100));
        const double back = std::sin(std::ldexp(tilt_counts(counts, profile), -29));
        CHECK(back * kOneG == Approx(counts).margin(0.1));
    }
    CHECK(tilt_counts(0, profile) == 0);
    CHECK(tilt_counts(kOneG / 2, profile) == 281104952);  // pi / 6.
}

TEST_CASE("tilt is limited to 60 degrees", "[sim][register_machine]") {
    // Data sheet 7.8: 2182A470 for +60 degrees or more, DE7D5B90 for -60 degrees or less.
    Bench bench;
    CHECK(frame_with(bench, {"80 E4"}, {{kOneG, -20 * kOneG, 3 * kOneG}, 0}) ==
          "80 8E 08 21 82 A4 70 DE 7D 5B 90 21 82 A4 70 0D");
}

TEST_CASE("with tilt selected on one axis, acceleration and tilt can be read side by side",
          "[sim][register_machine]") {
    // Data sheet 5.13: frames carry what OUTPUT_SEL selects; the ACCL registers stay acceleration.
    Bench bench;
    const SensorSample sample{{kOneG / 2, kOneG / 2, kOneG}, 0};
    CHECK(frame_with(bench, {"80 84"}, sample) ==
          "80 8E 00 10 C1 52 38 00 80 00 00 01 00 00 00 0D");
    CHECK(bench.read("W0:30") == "0080");
    CHECK(bench.read("W0:3C") == "10C1");
    CHECK(bench.read("W0:3E") == "5238");
    CHECK(bench.read("W0:40") == "FFFF");
}

TEST_CASE("an invalid pair of rate and filter shows in tilt as in acceleration, without an alarm",
          "[sim][register_machine]") {
    Bench bench;
    bench.send({"FE 01", "80 E4", "85 06", "86 08", "88 01", "8C 00", "8D 87", "FE 00", "83 01"});
    bench.sample(Bench::kTransient);
    CHECK(bench.sample(1, {{20 * kOneG, 0, 0}, 0}) ==
          "80 8E 02 64 00 00 00 64 00 00 00 64 00 00 00 0D");
}
