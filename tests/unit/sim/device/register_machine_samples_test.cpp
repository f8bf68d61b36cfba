#include "tests/support/catch.hpp"

#include "protocol/text/csv.hpp"
#include "tests/unit/sim/device/machine_script.hpp"

using namespace a351;
using namespace a351::sim::device;
using namespace std::chrono_literals;

namespace {

/// Returns the sum of the 16-bit words of `payload`, modulo 65536.
unsigned word_sum(std::span<const std::byte> payload) {
    unsigned sum = 0;
    for (std::size_t i = 0; i < payload.size(); i += 2) {
        sum +=
            std::to_integer<unsigned>(payload[i]) * 256 + std::to_integer<unsigned>(payload[i + 1]);
    }
    return sum & 0xFFFFU;
}

}  // namespace

TEST_CASE("each of the 112 layouts streams its fields at their offsets",
          "[sim][register_machine]") {
    const auto table = text::read_csv(A351_GOLDEN "/wire/burst_layouts.csv");
    REQUIRE(table.row_count() == 112);
    // Values of kSample, flags of a healthy device with the factory's ND enables, COUNT after three
    // samples at 50 Hz.  The checksum is computed from the frame sent.
    const std::pair<const char*, std::string> kFields[] = {
        {"flag", "8E 00"},    {"temperature", "00 00 09 A2"}, {"x", "FF FC E3 88"},
        {"y", "00 09 3A 7A"}, {"z", "00 FF 06 24"},           {"count", "00 F0"}};
    for (std::size_t row = 0; row < table.row_count(); ++row) {
        const std::string& code = table.cell(row, "burst_ctrl");
        CAPTURE(code);
        Bench bench;
        bench.send({"FE 01", "85 06", "86 06", "88 01", "8D " + code.substr(0, 2),
                    "8C " + code.substr(2), "FE 00", "83 01"});
        bench.sample(Bench::kTransient + 2);
        const auto frame = bytes_of(bench.sample());
        REQUIRE(frame.size() == static_cast<std::size_t>(table.number(row, "size")));
        CHECK(frame.front() == std::byte{0x80});
        CHECK(frame.back() == std::byte{0x0D});
        std::size_t explained = 2;
        for (const auto& [name, hex] : kFields) {
            const auto offset = table.number_if_given(row, name);
            if (!offset) continue;
            const auto expected = bytes_of(hex);
            CAPTURE(name);
            CHECK(hex_of(std::span(frame).subspan(static_cast<std::size_t>(*offset),
                                                  expected.size())) == hex);
            explained += expected.size();
        }
        if (const auto at = table.number_if_given(row, "checksum")) {
            const auto offset = static_cast<std::size_t>(*at);
            CHECK(word_sum(std::span(frame).subspan(offset, 2)) ==
                  word_sum(std::span(frame).subspan(1, offset - 1)));
            explained += 2;
        }
        CHECK(explained == frame.size());
    }
}

TEST_CASE("without an axis in BURST_CTRL no frame is sent", "[sim][register_machine]") {
    Bench bench;
    bench.send({"FE 01", "85 06", "86 06", "88 01", "8D C0", "FE 00", "83 01"});
    CHECK(bench.sample(10).empty());
}

TEST_CASE("the first frame comes after the transient, with one step in COUNT",
          "[sim][register_machine]") {
    // Suppressed samples of data sheet table 5.3.
    struct Case {
        std::string_view rate, filter;
        int suppressed, step;
    };
    for (const Case c : {Case{"85 06", "86 06", 7, 80}, Case{"85 05", "86 06", 15, 40},
                         Case{"85 04", "86 08", 31, 20}, Case{"85 03", "86 08", 63, 8},
                         Case{"85 02", "86 08", 127, 4}, Case{"85 02", "86 04", 31, 4},
                         Case{"85 03", "86 04", 15, 8}, Case{"85 04", "86 03", 7, 20},
                         Case{"85 02", "86 02", 15, 4}, Case{"85 03", "86 01", 7, 8}}) {
        Bench bench;
        bench.send({"FE 01", c.rate, c.filter, "88 01", "FE 00", "83 01"});
        for (int run = 1; run <= 2; ++run) {
            std::vector<std::byte> frames;
            for (int i = 0; i < c.suppressed; ++i) {
                REQUIRE_FALSE(bench.machine.sample(kSample, frames));
            }
            REQUIRE(bench.machine.sample(kSample, frames)->count == c.step);
            REQUIRE(bench.machine.sample(kSample, frames)->count == 2 * c.step);
            CHECK(bench.machine.sampling_run() == run);
            bench.send({"83 02", "83 01"});  // After a restart the transient begins again.
        }
    }
}

TEST_CASE("data registers hold FFFF until the first sample after the transient",
          "[sim][register_machine]") {
    Bench bench;
    bench.send({"FE 01", "85 06", "86 06", "FE 00", "83 01"});
    bench.sample(Bench::kTransient);
    CHECK(bench.read("W0:0E") == "FFFF");
    CHECK(bench.read("W0:32") == "FFFF");
    CHECK(bench.read("W0:0A") == "0000");
    bench.sample();
    CHECK(bench.read("W0:10") == "09A2");
    CHECK(bench.read("W0:32") == "E388");
}

TEST_CASE("COUNT keeps its last value when sampling stops", "[sim][register_machine]") {
    // A real A352 at 200/s showed 07D0 after 100 samples (dump in the README of py_esensorlib).
    Bench bench;
    bench.send({"FE 01", "88 01", "FE 00", "83 01"});
    bench.sample(31 + 100);
    bench.send({"83 02"});
    bench.sample(10);
    CHECK(bench.read("W0:0A") == "07D0");
}

TEST_CASE("the counter can jump, and it counts samples that are not sent",
          "[sim][register_machine]") {
    Bench bench;
    bench.start_logging();
    bench.sample(Bench::kTransient + 1);
    bench.machine.jump_counter(160);
    bench.sample();
    CHECK(bench.read("W0:0A") == "0140");
    bench.machine.skip_sample();
    CHECK(bench.read("W0:0A") == "0190");
}

TEST_CASE("a filter that does not fit the rate gives ALIASI_ERR and 100 g on all axes",
          "[sim][register_machine]") {
    Bench bench;  // Factory: 200 Hz with 60 Hz; 50 Hz leaves it invalid.
    CHECK(bench.read("W0:06") == "0000");
    bench.write("W1:85 06");
    CHECK(bench.read("W0:06") == "0002");
    bench.send({"FE 01", "88 01", "8C 03", "8D C7", "FE 00", "83 01"});
    const std::string frame = bench.sample(8);
    CHECK(frame.substr(0, 8) == "80 8E 02");
    CHECK(frame.substr(21, 35) == "64 00 00 00 64 00 00 00 64 00 00 00");
    bench.send({"83 02"});
    bench.write("W1:86 06");
    CHECK(bench.read("W0:06") == "0000");
}

TEST_CASE("in manual mode each burst command sends one frame with the newest sample",
          "[sim][register_machine]") {
    Bench bench;
    bench.send({"FE 01", "85 06", "86 06", "8C 03", "8D C7", "FE 00", "83 01"});
    CHECK(bench.sample(8).empty());
    CHECK(bench.send({"06 00"}) == "06 8E 00 0D");
    CHECK(bench.send({"80 00"}) ==
          "80 8E 00 00 00 09 A2 FF FC E3 88 00 09 3A 7A 00 FF 06 24 00 50 BD 1C 0D");
    // The sample has been read: its new-data flags are gone.
    CHECK(bench.send({"80 00"}).substr(0, 8) == "80 00 00");
    CHECK(bench.send({"80 01"}).empty());
    CHECK(bench.send({"83 02", "80 00"}).empty());  // No burst outside sampling.
}

TEST_CASE("reading a value clears its new-data flag and no other", "[sim][register_machine]") {
    Bench bench;
    bench.send({"FE 01", "85 06", "86 06", "FE 00", "83 01"});
    bench.sample(Bench::kTransient + 1);
    for (const auto& [place, left] :
         {std::pair{"W0:30", "8600"}, {"W0:36", "8200"}, {"W0:38", "8000"}, {"W0:0E", "0000"}}) {
        CAPTURE(place);
        static_cast<void>(bench.read(place));
        CHECK(bench.read("W0:06") == left);
    }
    // Tilt is read with the same flags.
    bench.sample();
    for (const auto& [place, left] :
         {std::pair{"W0:3C", "8600"}, {"W0:42", "8200"}, {"W0:44", "8000"}, {"W0:48", "8000"}}) {
        CAPTURE(place);
        static_cast<void>(bench.read(place));
        CHECK(bench.read("W0:06") == left);
    }
    // A frame counts as a read of its fields: here temperature and X.
    bench.sample();
    bench.send({"83 02", "FE 01", "8C 00", "8D 44", "FE 00", "83 01"});
    bench.sample(Bench::kTransient + 1);
    CHECK(bench.send({"80 00"}).size() == 10 * 3 - 1);
    CHECK(bench.read("W0:06") == "0600");
}

TEST_CASE("new-data flags that are not enabled do not show", "[sim][register_machine]") {
    Bench bench;
    bench.send({"FE 01", "81 08", "85 06", "86 06", "FE 00", "83 01"});
    bench.sample(Bench::kTransient + 1);
    CHECK(bench.read("W0:06") == "0800");
}

TEST_CASE("the delay of a frame is the sum of group delay, internal delay and wire time",
          "[sim][register_machine]") {
    Bench bench;
    bench.start_logging();
    // 511/2 samples of 4 kHz, 430 us, 24 bytes of 10 bits at 460800 baud.
    CHECK(bench.machine.frame_delay() == 63'875'000ns + 430'000ns + 520'833ns);
}

TEST_CASE("frames come as fast as the baud rate allows, and UART_OVF reports dropped ones",
          "[sim][register_machine]") {
    struct Case {
        std::string_view baud, rate, filter;
        int transient, frames_a_second;
        bool overflows;
    };
    // 24 bytes of 10 bits: 480, 960 and 1920 a second.
    for (const Case c : {Case{"89 03", "85 04", "86 08", 31, 200, false},
                         Case{"89 03", "85 03", "86 08", 63, 480, true},
                         Case{"89 03", "85 02", "86 08", 127, 480, true},
                         Case{"89 02", "85 02", "86 08", 127, 960, true},
                         Case{"89 01", "85 02", "86 08", 127, 1000, false}}) {
        CAPTURE(c.baud, c.rate);
        Bench bench;
        bench.send(
            {"FE 01", c.baud, c.rate, c.filter, "88 01", "8C 03", "8D C7", "FE 00", "83 01"});
        bench.sample(c.transient);
        const int rate = bench.machine.output_rate_hz();
        const std::size_t bytes = bytes_of(bench.sample(10 * rate)).size();
        REQUIRE(bytes % 24 == 0);  // Frames are dropped whole.
        // Tolerance: a frame that still waits at the end, and one for the rounding of a period.
        CHECK(std::abs(static_cast<int>(bytes / 24) - 10 * c.frames_a_second) <= 2);
        // The next frame that is sent has EA; COUNT shows the loss.
        std::string last;
        for (int i = 0; i < 10 && last.empty(); ++i) last = bench.sample();
        CHECK(last.substr(0, 8) == (c.overflows ? "80 8E 01" : "80 8E 00"));
        bench.send({"83 02"});
        CHECK(bench.read("W0:04") == (c.overflows ? "0008" : "0000"));
    }
}

TEST_CASE("a frame that waits for the line is late by at most the time of one frame",
          "[sim][register_machine]") {
    Bench bench;
    bench.send({"FE 01", "89 03", "85 02", "86 08", "88 01", "8C 03", "8D C7", "FE 00", "83 01"});
    bench.sample(127);
    const Nanoseconds alone = bench.machine.frame_delay();
    constexpr Nanoseconds kFrameTime = 2'083'333ns;
    Nanoseconds left_before{0};
    for (int i = 0; i < 1000; ++i) {
        const Nanoseconds wait = bench.machine.frame_delay() - alone;
        const Nanoseconds leaves = i * 1ms + wait;
        if (bench.sample().empty()) continue;
        REQUIRE(wait <= kFrameTime);
        if (left_before > 0ns) REQUIRE(leaves - left_before >= kFrameTime - 2ns);
        left_before = leaves;
    }
}

TEST_CASE("with EXT_SEL only an external edge makes a sample, and COUNT follows their spacing",
          "[sim][register_machine]") {
    Bench bench;
    bench.send({"FE 01", "82 46", "85 06", "86 08", "88 01", "8C 03", "8D C7", "FE 00", "83 01"});
    bench.machine.external_edge(bench.now);
    CHECK(bench.sample(1, kSample).size() == 24 * 3 - 1);
    CHECK(bench.sample(4).empty());
    bench.machine.external_edge(bench.now);
    const std::string frame = bench.sample();
    // 60 Hz at 50/s would be invalid with the internal timer (note at table 5.4).
    CHECK(frame.substr(0, 8) == "80 8E 00");
    CHECK(frame.substr(21, 11) == "FF FC E3 88");
    CHECK(bench.read("W0:0A") == "01E0");  // Six periods of 80.
    CHECK(bench.sample().empty());
}
