#include "sim/line/line.hpp"

#include <algorithm>
#include <chrono>
#include "tests/support/catch.hpp"

#include "tests/unit/sim/device/machine_script.hpp"

using namespace a351::sim;
using namespace a351;
using namespace a351::sim::line;
using namespace a351::sim::truth;
using namespace std::chrono_literals;

namespace {

const std::vector<std::byte> kFrameBytes(24, std::byte{0x55});

/// A line and the fates of its frames, in the order in which they were settled.
struct SettledFrames {
    explicit SettledFrames(const scenario::LineParameters& parameters = {})
        : line(parameters, 1, UtcTime(0s), [this](const truth::Record& record) {
              settled.push_back(record.grid_index);
              fates.push_back(record.fate);
          }) {}

    /// Sends a frame; one that is lost on purpose has no bytes.
    void send(std::uint32_t index, UtcTime due = UtcTime(0s), Fate fate = Fate::intact,
              std::uint16_t run = 1) {
        truth::Record record;
        record.grid_index = index;
        record.utc = UtcTime(index * 20ms);
        record.sampling_run = run;
        record.fate = fate;
        line.send(fate == Fate::lost ? std::span<const std::byte>() : kFrameBytes, due, &record);
    }
    void hand_over_all(UtcTime now) { line.handed_over(line.shown(now).size(), now); }

    std::vector<std::uint32_t> settled;
    std::vector<Fate> fates;
    Line line;
};

std::vector<std::byte> every_byte() {
    std::vector<std::byte> all;
    for (int value = 0; value < 256; ++value) all.push_back(static_cast<std::byte>(value));
    return all;
}

using Indices = std::vector<std::uint32_t>;

}  // namespace

TEST_CASE("a frame counts as sent once its last byte has gone") {
    SettledFrames frames;
    Line& line = frames.line;
    const UtcTime due{1s};
    frames.send(7, due);
    frames.send(8, due + 20ms);
    CHECK(line.shown(due).size() == 24);
    line.handed_over(23, due + 1ms);
    CHECK(frames.settled.empty());
    line.handed_over(1, due + 3ms);
    CHECK(frames.settled == Indices{7});
    CHECK(line.report().largest_lateness == 3ms);
    line.handed_over(24, due + 22ms);
    CHECK(frames.settled == Indices{7, 8});
    CHECK(line.report().largest_lateness == 3ms);
    CHECK(line.report().frames_sent == 2);
    CHECK(line.is_empty());
}

TEST_CASE("bytes that the host has not seen are taken back from the line") {
    SettledFrames frames;
    const auto bytes = every_byte();
    frames.line.send(bytes, UtcTime(1s), nullptr);
    frames.line.handed_over(7, UtcTime(1s));
    CHECK(frames.line.take_back() == std::vector<std::byte>(bytes.begin() + 7, bytes.end()));
    CHECK(frames.line.is_empty());
    frames.line.send(kFrameBytes, UtcTime(2s), nullptr);
    CHECK(frames.line.shown(UtcTime(2s)).size() == kFrameBytes.size());
}

TEST_CASE("the steady lateness is the largest of the minima over blocks of fifty frames") {
    SettledFrames frames;
    for (std::uint32_t i = 0; i < 175; ++i) {
        // 0 to 9 ms; in the second block 4 to 13 ms; in the last, incomplete block 900 ms and more.
        const auto late = (i % 10 + (i / 50 == 1 ? 4 : i / 50 == 3 ? 900 : 0)) * 1ms;
        frames.send(i, UtcTime(i * 2s));
        frames.hand_over_all(UtcTime(i * 2s) + late);
    }
    CHECK(frames.line.report().steady_lateness == 4ms);
    CHECK(frames.line.report().largest_lateness == 909ms);
}

TEST_CASE("bytes leave in the order in which they came, including answers") {
    scenario::LineParameters parameters;
    parameters.latency_timer_ms = 16.0;
    parameters.is_bytewise = GENERATE(false, true);
    SettledFrames frames(parameters);
    Line& line = frames.line;
    std::vector<std::byte> expected, got;
    const auto take = [&](UtcTime now, std::size_t most) {
        const auto shown = line.shown(now).first(std::min(most, line.shown(now).size()));
        got.insert(got.end(), shown.begin(), shown.end());
        line.handed_over(shown.size(), now);
    };
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const std::vector<std::byte> bytes(1 + i % 24, static_cast<std::byte>(i & 0xFFU));
        expected.insert(expected.end(), bytes.begin(), bytes.end());
        truth::Record record;
        record.sampling_run = 1;
        line.send(bytes, UtcTime(i * 20ms), i % 10 == 3 ? nullptr : &record);
        take(UtcTime(i * 20ms), 13);
    }
    while (!line.is_empty()) take(UtcTime(30s), SIZE_MAX);
    CHECK(got == expected);
    CHECK(frames.settled.size() == 900);
    CHECK(line.report().bytes_handed_over == static_cast<std::int64_t>(expected.size()));
    CHECK(line.report().bytes_of_answers + line.report().bytes_of_frames ==
          line.report().bytes_handed_over);
}

TEST_CASE("every frame has one fate, wherever an overrun, unplugging or the end cuts the stream") {
    enum class Cut { overrun, unplugging, end };
    for (const Cut by : {Cut::overrun, Cut::unplugging, Cut::end}) {
        for (std::size_t cut = 0; cut <= 3 * 24; ++cut) {
            CAPTURE(static_cast<int>(by), cut);
            SettledFrames frames;
            Line& line = frames.line;
            for (std::uint32_t i = 0; i < 3; ++i) frames.send(i);
            line.handed_over(cut, UtcTime(0s));
            if (by == Cut::overrun) line.overrun(3 * 24 - cut, UtcTime(0s));
            if (by == Cut::unplugging) line.unplug(UtcTime(0s));
            if (by == Cut::end) line.abandon(UtcTime(0s));
            REQUIRE(frames.fates.size() == 3);
            for (std::size_t i = 0; i < 3; ++i) {
                CHECK(frames.fates[i] == (24 * (i + 1) <= cut ? Fate::intact
                                          : 24 * i >= cut     ? Fate::lost
                                                              : Fate::damaged));
            }
            const line::Report& report = line.report();
            const auto whole = static_cast<std::int64_t>(cut / 24);
            CHECK(report.frames_made == 3);
            CHECK(report.frames_sent == whole);
            CHECK(report.frames_damaged == (cut % 24 > 0 ? 1 : 0));
            const std::int64_t rest = 3 - whole - report.frames_damaged;
            CHECK(report.frames_lost == (by == Cut::end ? 0 : rest));
            CHECK(report.lost_by_overrun == (by == Cut::overrun ? rest : 0));
            CHECK(report.lost_unplugged == (by == Cut::unplugging ? rest : 0));
            CHECK(report.frames_pending == (by == Cut::end ? rest : 0));
            CHECK(report.bytes_handed_over == static_cast<std::int64_t>(cut));
            CHECK(line.is_empty());
        }
    }
}

TEST_CASE("frames lost on purpose are not counted again as lost by unplugging or overrun") {
    for (const bool is_overrun : {true, false}) {
        SettledFrames frames;
        frames.line.hold_until(UtcTime(1h));
        for (const std::uint32_t i : {0U, 1U, 2U, 3U})
            frames.send(i, UtcTime(0s), i == 1 || i == 2 ? Fate::lost : Fate::intact);
        is_overrun ? frames.line.overrun(2 * 24, UtcTime(0s)) : frames.line.unplug(UtcTime(0s));
        const line::Report& report = frames.line.report();
        CHECK(report.frames_lost == 4);
        CHECK((is_overrun ? report.lost_by_overrun : report.lost_unplugged) == 2);
    }
}

TEST_CASE("a lost frame without bytes is settled in its turn") {
    SettledFrames frames;
    frames.send(1);
    frames.send(2, UtcTime(0s), Fate::lost);
    frames.send(3);
    CHECK(frames.settled.empty());
    frames.line.handed_over(24, UtcTime(0s));
    CHECK(frames.settled == Indices{1, 2});
    frames.line.handed_over(24, UtcTime(0s));
    CHECK(frames.settled == Indices{1, 2, 3});
}

TEST_CASE("no frame arrives if device and host have different speeds") {
    SettledFrames frames;
    frames.line.set_speeds(460800, 115200);
    frames.send(1);
    const std::size_t size = frames.line.shown(UtcTime(0s)).size();
    CHECK((size > 0 && size < 24));
    frames.line.handed_over(size, UtcTime(0s));
    CHECK(frames.line.report().frames_damaged == 1);
    CHECK(frames.line.report().frames_sent == 0);
}

TEST_CASE("paced bytes arrive one by one, each when it ends on the wire") {
    scenario::LineParameters parameters;
    parameters.is_paced = true;
    SettledFrames frames(parameters);
    frames.line.set_speeds(115200, 115200);
    const UtcTime leaves{1s};
    REQUIRE(frames.line.lead() == Nanoseconds(1s) * 240 / 115200);
    frames.send(1, leaves);
    for (std::int64_t left = 0; left < 24; ++left) {
        const UtcTime end = leaves - Nanoseconds(1s) * left * 10 / 115200;
        CHECK(frames.line.shown(end).size() == static_cast<std::size_t>(24 - left));
        CHECK(frames.line.shown(end - 1us).size() == static_cast<std::size_t>(23 - left));
    }
}

TEST_CASE("runs of sampling are counted separately") {
    SettledFrames frames;
    for (const std::uint32_t index : {7U, 8U, 1008U, 1009U, 1010U})
        frames.send(index, UtcTime(0s), Fate::intact, index < 1000 ? 1 : 2);
    frames.hand_over_all(UtcTime(0s));
    REQUIRE(frames.line.report().runs.size() == 2);
    CHECK(frames.line.report().runs[0].first_index == 7);
    CHECK(frames.line.report().runs[0].frames == 2);
    CHECK(frames.line.report().runs[1].first_index == 1008);
    CHECK(frames.line.report().runs[1].frames == 3);
}

TEST_CASE("a speed error of less than half a bit in ten changes no byte") {
    const auto all = every_byte();
    for (const int baud : {9600, 115200, 460800}) CHECK(received_at_baud(all, baud, baud) == all);
    CHECK(received_at_baud({}, 115200, 460800).empty());
    CHECK(received_at_baud(all, 100000, 102000) == all);
    CHECK(received_at_baud(all, 102000, 100000) == all);
    CHECK(received_at_baud(all, 100000, 120000) != all);
}

TEST_CASE("at half the speed two bytes are received as one, at twice the speed one byte as two") {
    using device::bytes_of;
    using device::hex_of;
    // Bits on the line: 0 is the start bit, 1 to 8 are low, 9 is the stop bit, then the same again.
    // At half the speed bits 3, 5, 7 and 9 become the first data bits, so the fourth one is high.
    CHECK(hex_of(received_at_baud(bytes_of("00 00"), 2, 1)) == "08");
    // 0x00 sent at f and received at 2 f is 18 low half bits: a start bit, eight low bits, a low
    // stop bit, and the same again.
    CHECK(received_at_baud(bytes_of("00"), 1, 2).size() == 2);
    CHECK(hex_of(received_at_baud(bytes_of("F0"), 1, 2)).substr(0, 2) == "00");
}
