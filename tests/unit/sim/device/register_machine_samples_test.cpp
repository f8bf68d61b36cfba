#include <cmath>
#include "tests/support/catch.hpp"

#include "protocol/text/csv.hpp"
#include "sim/device/signal_path.hpp"
#include "tests/unit/sim/device/machine_script.hpp"

using namespace a351;
using namespace a351::sim::device;
using namespace a351::sim::signal;
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

TEST_CASE("each of the 112 layouts streams its fields at their offsets") {
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
    Bench bench;
    bench.send({"FE 01", "85 06", "86 06", "88 01", "8D C0", "FE 00", "83 01"});  // No axis.
    CHECK(bench.sample(10).empty());
}

TEST_CASE("the first frame comes after the transient, with one step in COUNT") {
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

TEST_CASE("COUNT can jump, counts samples that are not sent, and keeps its value after a stop") {
    // A real A352 at 200/s showed 07D0 after 100 samples (dump in the README of py_esensorlib).
    Bench bench;
    bench.send({"FE 01", "88 01", "FE 00", "83 01"});
    bench.sample(31 + 90);
    bench.machine.jump_counter(160);
    bench.sample();
    bench.machine.skip_sample();
    bench.send({"83 02"});
    bench.sample(10);
    CHECK(bench.read("W0:0A") == "07D0");
}

TEST_CASE("in manual mode each burst command sends one frame with the newest sample") {
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

TEST_CASE("reading a value clears its new-data flag and no other") {
    Bench bench;
    bench.send({"FE 01", "85 06", "86 06", "FE 00", "83 01"});
    bench.sample(Bench::kTransient);
    for (const char* place : {"W0:0A", "W0:0E", "W0:32"})  // No sample yet.
        CHECK(bench.read(place) == (place == std::string("W0:0A") ? "0000" : "FFFF"));
    bench.sample();
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
    // Flags that are not enabled do not show.
    bench.send({"83 02", "FE 01", "81 08", "FE 00", "83 01"});
    bench.sample(Bench::kTransient + 1);
    CHECK(bench.read("W0:06") == "0800");
}

TEST_CASE("frames come as fast as the baud rate allows, and UART_OVF reports dropped ones") {
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

TEST_CASE("a frame is late by group delay, internal delay, wire time and at most one earlier frame") {
    Bench bench;
    bench.send({"FE 01", "89 03", "85 02", "86 08", "88 01", "8C 03", "8D C7", "FE 00", "83 01"});
    bench.sample(127);
    constexpr Nanoseconds kFrameTime = 2'083'333ns;  // 24 bytes of 10 bits at 115200 baud.
    // 511/2 samples of 4 kHz, and 430 us.
    const Nanoseconds alone = 63'875'000ns + 430'000ns + kFrameTime;
    CHECK(bench.machine.frame_delay() == alone);
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

TEST_CASE("with EXT_SEL only an external edge makes a sample, and COUNT follows their spacing") {
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

TEST_CASE("frames carry acceleration with offset and alarm limits, or tilt within 60 degrees") {
    struct Row {
        std::vector<std::string_view> settings;
        std::array<std::int32_t, 3> axes;
        std::string_view flag_and_axes;
    };
    constexpr std::int32_t k15G = 15 * kOneG;
    const Row kRows[] = {
        // Offsets.  Data sheet 8.2: +1.23 g on X is 013AE147.
        {{"AD 01", "AC 3A", "AF E1", "AE 47"},
         {kOneG, kOneG, kOneG},
         "8E 00 02 3A E1 47 01 00 00 00 01 00 00 00"},
        {{"B1 FF", "B0 FF", "B3 FF", "B2 FF", "B5 FF"},
         {kOneG, kOneG, kOneG},
         "8E 00 01 00 00 00 00 FF FF FF 00 00 00 00"},
        // Beyond an alarm limit the output is the limit, and the alarm flag is set.  The factory's
        // are 15 g; a value at the limit is not beyond it.
        {{}, {k15G + 1, -k15G - 1, k15G}, "8E 18 0F 00 00 00 F1 00 00 00 0F 00 00 00"},
        // Data sheet 8.2: X within 5 g.
        {{"C7 05", "C6 FB"},
         {6 * kOneG, 6 * kOneG, -6 * kOneG},
         "8E 10 05 00 00 00 06 00 00 00 FA 00 00 00"},
        // Data sheet 7.8: 2182A470 for +60 degrees or more, DE7D5B90 for -60 degrees or less.
        {{"80 E4"}, {kOneG, -20 * kOneG, 3 * kOneG}, "8E 08 21 82 A4 70 DE 7D 5B 90 21 82 A4 70"},
        // An invalid pair of rate and filter shows as 100 g, also in tilt, without an alarm.
        {{"86 08"}, {20 * kOneG, 0, 0}, "8E 02 64 00 00 00 64 00 00 00 64 00 00 00"},
        {{"80 E4", "86 08"}, {20 * kOneG, 0, 0}, "8E 02 64 00 00 00 64 00 00 00 64 00 00 00"},
    };
    for (const Row& row : kRows) {
        CAPTURE(row.flag_and_axes);
        Bench bench;
        bench.send({"FE 01", "85 06", "86 06", "88 01", "8C 00", "8D 87"});
        bench.send(row.settings);
        bench.send({"FE 00", "83 01"});
        bench.sample(Bench::kTransient, SensorSample{});
        CHECK(bench.sample(1, {row.axes, 0}) == "80 " + std::string(row.flag_and_axes) + " 0D");
    }
}

TEST_CASE("an alarm stays until FLAG is read, by command or by a frame that carries it") {
    const SensorSample shaken{{0, 0, 20 * kOneG}, 0};
    const SensorSample calm{{0, 0, kOneG}, 0};
    Bench bench;
    bench.send({"FE 01", "85 06", "86 06", "88 01", "8C 03", "8D 47", "FE 00", "83 01"});
    bench.sample(Bench::kTransient);
    std::vector<std::byte> frames;
    const auto values = bench.machine.sample(shaken, frames);
    REQUIRE(values);
    CHECK(values->flag == 0);  // No FLAG in this frame.
    bench.sample(5, calm);
    CHECK((std::stoi(bench.read("W0:06"), nullptr, 16) & 0x1C) == 0x04);
    CHECK((std::stoi(bench.read("W0:06"), nullptr, 16) & 0x1C) == 0);
    bench.send({"83 02", "FE 01", "8D C7", "FE 00", "83 01"});
    bench.sample(Bench::kTransient);
    CHECK(bench.sample(1, shaken).substr(0, 8) == "80 8E 04");
    CHECK(bench.sample(1, calm).substr(0, 8) == "80 8E 00");
}

TEST_CASE("tilt is the arc sine of the acceleration, in radians times 2^29") {
    const auto& profile = *wire::find_profile("A352AD10");
    for (int i = -86; i <= 86; ++i) {  // sin 60 degrees is 0.866.
        const auto counts = static_cast<std::int32_t>(i * (kOneG / 100));
        const double back = std::sin(std::ldexp(tilt_counts(counts, profile), -29));
        CHECK(back * kOneG == Approx(counts).margin(0.1));
    }
    CHECK(tilt_counts(0, profile) == 0);
    CHECK(tilt_counts(kOneG / 2, profile) == 281104952);  // pi / 6.
}

TEST_CASE("with tilt selected on one axis, acceleration and tilt can be read side by side") {
    // Data sheet 5.13: frames carry what OUTPUT_SEL selects; the ACCL registers stay acceleration.
    Bench bench;
    bench.send({"FE 01", "80 84"});
    bench.start_logging();
    bench.sample(Bench::kTransient);
    CHECK(bench.sample(1, {{kOneG / 2, kOneG / 2, kOneG}, 0}).substr(21, 35) ==
          "10 C1 52 38 00 80 00 00 01 00 00 00");
    CHECK(bench.read("W0:30") == "0080");
    CHECK(bench.read("W0:3C") == "10C1");
    CHECK(bench.read("W0:3E") == "5238");
    CHECK(bench.read("W0:40") == "FFFF");
}
