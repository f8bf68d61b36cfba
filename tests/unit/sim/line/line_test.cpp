#include "sim/line/line.hpp"

#include <algorithm>
#include <chrono>
#include "tests/support/catch.hpp"

using namespace a351::sim;
using namespace a351;
using namespace a351::sim::line;
using namespace a351::sim::scenario;
using namespace a351::sim::truth;
using namespace std::chrono_literals;

namespace {

truth::Record frame_of(std::uint32_t index, std::uint16_t run = 1) {
    truth::Record record;
    record.grid_index = index;
    record.sampling_run = run;
    return record;
}

const std::vector<std::byte> kFrame(24, std::byte{0x55});

}  // namespace

TEST_CASE("a frame counts as sent once its last byte has gone", "[sim][line]") {
    std::vector<std::uint32_t> sent;
    Line line({}, 1, UtcTime(0s),
              [&sent](const truth::Record& record) { sent.push_back(record.grid_index); });
    const UtcTime due{1s};
    const truth::Record first = frame_of(7), second = frame_of(8);
    line.send(kFrame, due, &first);
    line.send(kFrame, due + 20ms, &second);
    CHECK(line.shown(due).size() == 24);
    line.handed_over(23, due + 1ms);
    CHECK(sent.empty());
    line.handed_over(1, due + 3ms);
    CHECK(sent == std::vector<std::uint32_t>{7});
    CHECK(line.report().largest_lateness == 3ms);
    line.handed_over(24, due + 22ms);
    CHECK(sent == std::vector<std::uint32_t>{7, 8});
    CHECK(line.report().largest_lateness == 3ms);
    CHECK(line.report().frames_sent == 2);
    CHECK(line.is_empty());
}

TEST_CASE("bytes that the host has not seen are taken back from the line", "[sim][line]") {
    Line line({}, 1, UtcTime(0s), [](const truth::Record&) {});
    std::vector<std::byte> bytes(48);
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i);
    line.send(bytes, UtcTime(1s), nullptr);
    line.handed_over(7, UtcTime(1s));
    CHECK(line.take_back() == std::vector<std::byte>(bytes.begin() + 7, bytes.end()));
    CHECK(line.is_empty());
    line.send(kFrame, UtcTime(2s), nullptr);
    CHECK(line.shown(UtcTime(2s)).size() == kFrame.size());
}

TEST_CASE("the steady lateness is the largest of the minima over blocks of fifty frames",
          "[sim][line]") {
    Line line({}, 1, UtcTime(0s), [](const truth::Record&) {});
    for (std::uint32_t i = 0; i < 175; ++i) {
        // 0 to 9 ms; in the second block 4 to 13 ms; in the last, incomplete block 900 ms and more.
        const auto late = (i % 10 + (i / 50 == 1 ? 4 : i / 50 == 3 ? 900 : 0)) * 1ms;
        const truth::Record frame = frame_of(i);
        line.send(kFrame, UtcTime(i * 2s), &frame);
        line.handed_over(line.shown(UtcTime(i * 2s) + late).size(), UtcTime(i * 2s) + late);
    }
    CHECK(line.report().steady_lateness == 4ms);
    CHECK(line.report().largest_lateness == 909ms);
}

TEST_CASE("bytes leave in the order in which they came, including answers", "[sim][line]") {
    for (const bool is_bytewise : {false, true}) {
        LineParameters parameters;
        parameters.latency_timer_ms = 16.0;
        parameters.is_bytewise = is_bytewise;
        std::vector<truth::Record> sent;
        Line line(parameters, 1, UtcTime(0s),
                  [&sent](const truth::Record& record) { sent.push_back(record); });
        std::vector<std::byte> expected, got;
        const auto take = [&](UtcTime now, std::size_t most) {
            const auto shown = line.shown(now).first(std::min(most, line.shown(now).size()));
            got.insert(got.end(), shown.begin(), shown.end());
            line.handed_over(shown.size(), now);
        };
        for (std::uint32_t i = 0; i < 1000; ++i) {
            const std::vector<std::byte> bytes(1 + i % 24, static_cast<std::byte>(i & 0xFFU));
            expected.insert(expected.end(), bytes.begin(), bytes.end());
            const truth::Record record = frame_of(i);
            line.send(bytes, UtcTime(i * 20ms), i % 10 == 3 ? nullptr : &record);
            take(UtcTime(i * 20ms), 13);
        }
        while (!line.is_empty()) take(UtcTime(30s), SIZE_MAX);
        CHECK(got == expected);
        CHECK(sent.size() == 900);
        CHECK(line.report().bytes_handed_over == static_cast<std::int64_t>(expected.size()));
        CHECK(line.report().bytes_of_answers + line.report().bytes_of_frames ==
              line.report().bytes_handed_over);
    }
}

TEST_CASE("every frame has one fate, wherever an overrun or unplugging cuts the stream",
          "[sim][line]") {
    for (std::size_t cut = 0; cut <= 3 * 24; ++cut) {
        for (const bool is_overrun : {true, false}) {
            CAPTURE(cut, is_overrun);
            std::vector<Fate> fates;
            Line line({}, 1, UtcTime(0s),
                      [&fates](const truth::Record& record) { fates.push_back(record.fate); });
            for (std::uint32_t i = 0; i < 3; ++i) {
                truth::Record record = frame_of(i);
                record.utc = UtcTime(i * 20ms);
                line.send(kFrame, UtcTime(0s), &record);
            }
            line.handed_over(cut, UtcTime(0s));
            is_overrun ? line.overrun(3 * 24 - cut, UtcTime(0s)) : line.unplug(UtcTime(0s));
            REQUIRE(fates.size() == 3);
            for (std::size_t i = 0; i < 3; ++i) {
                CHECK(fates[i] == (24 * (i + 1) <= cut ? Fate::intact
                                   : 24 * i >= cut     ? Fate::lost
                                                       : Fate::damaged));
            }
            const line::Report& report = line.report();
            CHECK(report.frames_made == 3);
            CHECK(report.frames_sent + report.frames_lost + report.frames_damaged == 3);
            CHECK((is_overrun ? report.lost_by_overrun : report.lost_unplugged) ==
                  report.frames_lost);
            CHECK(report.bytes_handed_over == static_cast<std::int64_t>(cut));
            CHECK(line.is_empty());
        }
    }
}

TEST_CASE("frames sent while unplugged are lost, and none after plugging in", "[sim][line]") {
    std::vector<Fate> fates;
    Line line({}, 1, UtcTime(0s),
              [&fates](const truth::Record& record) { fates.push_back(record.fate); });
    const auto send = [&line](std::uint32_t index) {
        truth::Record record = frame_of(index);
        record.utc = UtcTime(index * 20ms);
        line.send(kFrame, record.utc, &record);
    };
    line.unplug(UtcTime(0s));
    send(1);
    send(2);
    line.plug_in();
    send(3);
    line.handed_over(line.shown(UtcTime(1s)).size(), UtcTime(1s));
    CHECK(fates == std::vector{Fate::lost, Fate::lost, Fate::intact});
    CHECK(line.report().bytes_handed_over == 24);
}

TEST_CASE("frames lost on purpose are not counted again as lost by unplugging or overrun",
          "[sim][line]") {
    for (const bool is_overrun : {true, false}) {
        Line line({}, 1, UtcTime(0s), [](const truth::Record&) {});
        line.hold_until(UtcTime(1h));
        for (std::uint32_t i = 0; i < 4; ++i) {
            truth::Record record = frame_of(i);
            record.utc = UtcTime(i * 20ms);
            if (i == 1 || i == 2) record.fate = Fate::lost;
            line.send(i == 1 || i == 2 ? std::span<const std::byte>() : kFrame, UtcTime(0s),
                      &record);
        }
        is_overrun ? line.overrun(2 * 24, UtcTime(0s)) : line.unplug(UtcTime(0s));
        const line::Report& report = line.report();
        CHECK(report.frames_lost == 4);
        CHECK((is_overrun ? report.lost_by_overrun : report.lost_unplugged) == 2);
    }
}

TEST_CASE("at the end each frame has a fate, wherever the host stopped reading", "[sim][line]") {
    for (std::size_t cut = 0; cut <= 3 * 24; ++cut) {
        CAPTURE(cut);
        std::vector<Fate> fates;
        Line line({}, 1, UtcTime(0s),
                  [&fates](const truth::Record& record) { fates.push_back(record.fate); });
        for (std::uint32_t i = 0; i < 3; ++i) {
            truth::Record record = frame_of(i);
            record.utc = UtcTime(i * 20ms);
            line.send(kFrame, UtcTime(0s), &record);
        }
        line.handed_over(cut, UtcTime(0s));
        line.abandon(UtcTime(0s));
        REQUIRE(fates.size() == 3);
        const line::Report& report = line.report();
        const auto whole = static_cast<std::int64_t>(cut / 24);
        CHECK(report.frames_sent == whole);
        CHECK(report.frames_damaged == (cut % 24 > 0 ? 1 : 0));
        CHECK(report.frames_pending == 3 - whole - report.frames_damaged);
        CHECK(report.frames_lost == 0);
        CHECK(std::ranges::count(fates, Fate::lost) == report.frames_pending);
        CHECK(line.is_empty());
    }
}

TEST_CASE("a lost frame without bytes is settled in its turn", "[sim][line]") {
    std::vector<std::uint32_t> settled;
    Line line({}, 1, UtcTime(0s),
              [&settled](const truth::Record& record) { settled.push_back(record.grid_index); });
    truth::Record lost = frame_of(2);
    lost.fate = Fate::lost;
    const truth::Record before = frame_of(1), behind = frame_of(3);
    line.send(kFrame, UtcTime(0s), &before);
    line.send({}, UtcTime(0s), &lost);
    line.send(kFrame, UtcTime(0s), &behind);
    CHECK(settled.empty());
    line.handed_over(24, UtcTime(0s));
    CHECK(settled == std::vector<std::uint32_t>{1, 2});
    line.handed_over(24, UtcTime(0s));
    CHECK(settled == std::vector<std::uint32_t>{1, 2, 3});
}

TEST_CASE("no frame arrives if device and host have different speeds", "[sim][line]") {
    Line line({}, 1, UtcTime(0s), [](const truth::Record&) {});
    line.set_speeds(460800, 115200);
    const truth::Record record = frame_of(1);
    line.send(kFrame, UtcTime(0s), &record);
    const std::size_t size = line.shown(UtcTime(0s)).size();
    CHECK((size > 0 && size < 24));
    line.handed_over(size, UtcTime(0s));
    CHECK(line.report().frames_damaged == 1);
    CHECK(line.report().frames_sent == 0);
}

TEST_CASE("paced bytes arrive one by one, each when it ends on the wire", "[sim][line]") {
    LineParameters parameters;
    parameters.is_paced = true;
    Line line(parameters, 1, UtcTime(0s), [](const truth::Record&) {});
    line.set_speeds(115200, 115200);
    const UtcTime leaves{1s};
    const truth::Record record = frame_of(1);
    REQUIRE(line.lead() == Nanoseconds(1s) * 240 / 115200);
    line.send(kFrame, leaves, &record);
    for (std::int64_t left = 0; left < 24; ++left) {
        const UtcTime end = leaves - Nanoseconds(1s) * left * 10 / 115200;
        CHECK(line.shown(end).size() == static_cast<std::size_t>(24 - left));
        CHECK(line.shown(end - 1us).size() == static_cast<std::size_t>(23 - left));
    }
}

TEST_CASE("runs of sampling are counted separately", "[sim][line]") {
    Line line({}, 1, UtcTime(0s), [](const truth::Record&) {});
    for (const auto& [index, run] : {std::pair{7, 1}, {8, 1}, {1008, 2}, {1009, 2}, {1010, 2}}) {
        const truth::Record record =
            frame_of(static_cast<std::uint32_t>(index), static_cast<std::uint16_t>(run));
        line.send(kFrame, UtcTime(0s), &record);
    }
    line.handed_over(line.shown(UtcTime(1h)).size(), UtcTime(0s));
    REQUIRE(line.report().runs.size() == 2);
    CHECK(line.report().runs[0].first_index == 7);
    CHECK(line.report().runs[0].frames == 2);
    CHECK(line.report().runs[1].first_index == 1008);
    CHECK(line.report().runs[1].frames == 3);
}
