#include "sim/device/signal_path.hpp"

#include "tests/support/catch.hpp"

#include "tests/unit/sim/device/machine_script.hpp"

using namespace a351;
using namespace a351::sim::device;
using Kind = LongTermFilter::Kind;

TEST_CASE("the low-pass settles on a constant after twice its taps, the high-pass after its taps",
          "[sim][long_term_filter]") {
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

TEST_CASE("a pulse comes out of the low-pass as a triangle", "[sim][long_term_filter]") {
    LongTermFilter filter;
    filter.start(Kind::low_pass, 2);
    const std::int32_t expected[] = {100, 200, 300, 400, 300, 200, 100, 0, 0};
    std::int32_t input = 1600;
    for (const std::int32_t value : expected) {
        CHECK(filter.next({input, 0, 0})[0] == value);
        input = 0;
    }
}

TEST_CASE("a restarted long-term filter forgets the earlier samples", "[sim][long_term_filter]") {
    LongTermFilter filter;
    filter.start(Kind::low_pass, 1);
    static_cast<void>(filter.next({4000, 0, 0}));
    filter.start(Kind::low_pass, 1);
    CHECK(filter.next({4, 0, 0})[0] == 1);
    filter.start(Kind::off, 1);
    CHECK(filter.next({5, 6, 7}) == std::array<std::int32_t, 3>{5, 6, 7});
}

TEST_CASE("LONGFILT_CTRL and LONGFILT_TAP act on the samples of the device",
          "[sim][long_term_filter]") {
    Bench bench;
    bench.send(
        {"FE 01", "9C 03", "9E 02", "85 06", "86 06", "88 01", "8C 00", "8D 01", "FE 00", "83 01"});
    bench.sample(Bench::kTransient, {{0, 0, 400}, 0});
    // The high-pass of four taps: the level less 1/4, 2/4, 3/4, 4/4 of it.
    CHECK(bench.sample(5, {{0, 0, 400}, 0}) ==
          "80 00 00 01 2C 0D 80 00 00 00 C8 0D 80 00 00 00 64 0D 80 00 00 00 00 0D "
          "80 00 00 00 00 0D");
}

TEST_CASE("the long-term filter and 1000 samples a second exclude each other",
          "[sim][long_term_filter]") {
    Bench bench;
    bench.send({"FE 01", "9C 01", "85 02"});
    CHECK(bench.read("W1:04") == "0400");
    bench.send({"FE 01", "9C 00", "85 02", "9C 01"});
    CHECK(bench.read("W1:04") == "0200");
    CHECK(bench.read("W1:1C") == "0000");
}
