#include "sim/line/fault_injector.hpp"

#include "tests/support/catch.hpp"

#include "tests/unit/sim/line/fault_rig.hpp"

using namespace a351;
using namespace a351::sim::device;
using namespace a351::sim::line;
using namespace a351::sim::truth;

TEST_CASE("each fault of the stream leaves its marks at the host and in the report") {
    struct Row {
        std::string kind, keys;
        std::int64_t missing;        ///< Samples that the host misses.
        std::size_t skipped;         ///< Bytes that are not of a frame.
        Fate fate;                   ///< Of the frames that it hits,
        std::int64_t hit;            ///< as many,
        std::size_t first;           ///< from this one on.
        std::map<Kind, int> places;  ///< How the host places frames.
    };
    using Places = std::map<Kind, int>;
    const Places gap{{Kind::after_gap, 1}};
    const Places swap{{Kind::anomaly, 2}, {Kind::after_gap, 2}};
    const Places restart{{Kind::anomaly, 1}, {Kind::new_session, 1}};
    const auto again = [](int count) { return Places{{Kind::duplicate, count}}; };
    const Row row = GENERATE_REF(values<Row>({
        {"flip_bit", "count = 200\nbits = 1", 200, 4800, Fate::damaged, 200, 100, {}},
        {"flip_bit", "count = 200\nbits = 2", 200, 4800, Fate::damaged, 200, 100, {}},
        {"flip_bit", "count = 200\nbits = 3", 200, 4800, Fate::damaged, 200, 100, {}},
        {"flip_bit", "count = 200\nbits = 8", 200, 4800, Fate::damaged, 200, 100, {}},
        {"flip_bit", "count = 200\nbits = 16", 200, 4800, Fate::damaged, 200, 100, {}},
        {"bad_checksum", "count = 3", 3, 72, Fate::damaged, 3, 100, gap},
        {"stall", "seconds = 4", 0, 0, Fate::lost, 0, 0, {}},  // The case of two faults sees the delay.
        {"garbage", "count = 20\nbytes = 1", 0, 20, Fate::damaged, 0, 0, {}},
        {"garbage", "count = 20\nbytes = 23", 0, 460, Fate::damaged, 0, 0, {}},
        {"garbage", "count = 20\nbytes = 24", 0, 480, Fate::damaged, 0, 0, {}},
        {"garbage", "count = 20\nbytes = 10000", 0, 200'000, Fate::damaged, 0, 0, {}},
        {"duplicate_frame", "count = 10", 0, 0, Fate::repeated, 10, 101, again(10)},
        {"reorder_frames", "count = 2", 2, 0, Fate::misplaced, 2, 101, swap},
        {"lose_frames", "count = 1", 1, 0, Fate::lost, 1, 100, gap},
        {"lose_frames", "count = 5", 5, 0, Fate::lost, 5, 100, gap},
        {"lose_frames", "count = 700", 700, 0, Fate::lost, 700, 100, gap},
        {"silence", "seconds = 4", 200, 0, Fate::lost, 200, 100, gap},  // It continues to count.
        {"counter_jump", "count = 1", 1, 0, Fate::misplaced, 0, 0, gap},
        {"counter_jump", "count = 10", 10, 0, Fate::misplaced, 0, 0, gap},
        {"counter_jump", "count = 400", 400, 0, Fate::misplaced, 0, 0, gap},
        {"counter_jump", "ticks = 7", 0, 0, Fate::misplaced, 1, 101, restart},
        {"counter_stuck", "count = 1", 1, 0, Fate::repeated, 1, 101, again(1)},
        {"counter_stuck", "count = 2", 2, 0, Fate::repeated, 2, 101, again(2)},
        {"counter_stuck", "count = 30", 30, 0, Fate::repeated, 30, 101, again(30)},
        {"counter_reset", "", 0, 0, Fate::misplaced, 1, 101, restart},
    }));
    CAPTURE(row.kind, row.keys);
    Rig rig(fault(row.kind, "at_frame = 100\n" + row.keys));
    Decoded decoded = check_report(rig);
    CHECK(decoded.missing == row.missing);
    CHECK(decoded.bytes_skipped == row.skipped);
    for (const auto& [place, count] : row.places) CHECK(decoded.places[place] == count);
    CHECK(rig.count(row.fate) == row.hit);
    CHECK(rig.count(Fate::intact) == static_cast<std::int64_t>(rig.truth.size()) - row.hit);
    if (row.hit > 0) CHECK(rig.truth.at(row.first).fate == row.fate);
    const bool is_run = row.kind != "duplicate_frame" && row.kind != "reorder_frames";
    if (row.hit > 0 && is_run) {
        CHECK(rig.truth.at(row.first + static_cast<std::size_t>(row.hit) - 1).fate == row.fate);
    }
    const auto count_of = [&rig](std::size_t i) { return rig.truth.at(i).values.count; };
    if (row.kind == "garbage")
        CHECK(rig.faults.report().bytes_garbage == static_cast<std::int64_t>(row.skipped));
    if (row.kind == "duplicate_frame") {
        CHECK(rig.truth[101].values == rig.truth[100].values);
        CHECK(rig.truth[101].utc == rig.truth[100].utc);
        CHECK(rig.line.report().frames_made == rig.line.report().frames_sent - 10);
    }
    if (row.kind == "reorder_frames") CHECK(rig.truth[101].utc + 20ms == rig.truth[100].utc);
    if (row.kind == "counter_stuck") {
        const auto last = static_cast<std::size_t>(100 + row.hit);
        CHECK(count_of(last) == count_of(100));
        CHECK(count_of(last + 1) == 80 * (last + 2) % 65536);
    }
    if (row.kind == "counter_reset") CHECK(count_of(101) == 80);
}

TEST_CASE("dropped, inserted and missing bytes cost only the frame they are in") {
    const std::string kind = GENERATE("drop_bytes", "insert_bytes", "truncate_frame");
    const int bytes = GENERATE(1, 2, 7, 100);
    CAPTURE(kind, bytes);
    const std::string keys = "at_frame = 100\ncount = 300\n";
    Rig rig(
        fault(kind, kind == "truncate_frame" ? keys : keys + "bytes = " + std::to_string(bytes)));
    const Decoded decoded = check_report(rig);
    CHECK(rig.count(Fate::damaged) == 300);
    CHECK(decoded.missing == 300);
    const FaultReport& report = rig.faults.report();
    CHECK(static_cast<std::int64_t>(decoded.bytes_skipped) ==
          300 * 24 + report.bytes_inserted - report.bytes_dropped);
    if (kind == "drop_bytes") CHECK(report.bytes_dropped == 300 * std::min(bytes, 23));
    if (kind == "insert_bytes") CHECK(report.bytes_inserted == 300 * bytes);
}

TEST_CASE("a reset, a power cut and a stop end the stream in configuration mode") {
    const std::string kind = GENERATE("reset", "power_cycle", "stop");
    CAPTURE(kind);
    Rig rig(fault(kind, "at_frame = 100"));
    check_report(rig);
    CHECK(rig.truth.size() == 101);
    CHECK_FALSE(rig.bench.machine.is_sampling());
    rig.bench.now += 1s;
    const auto mode = rig.bench.send({"FE 00", "02 00"});
    CHECK(mode == "02 04 00 0D");
    // Settings survive a stop only.
    CHECK(rig.bench.send({"FE 01", "0C 00"}) == (kind == "stop" ? "0C C7 03 0D" : "0C 47 02 0D"));
}

TEST_CASE("unplugging a port loses the frames until it is back") {
    Rig rig(fault("hang_up", "at_frame = 100\nseconds = 4"));
    rig.run_to(UtcTime(10s));
    const auto hang_up = rig.faults.take_hang_up();
    REQUIRE(hang_up);
    CHECK_FALSE(rig.faults.take_hang_up());
    CHECK(hang_up->until - rig.faults.report().applied.at(0).at == 4s);
    rig.faults.end_hang_up(*hang_up, {rig.now, rig.bench.now});
    Decoded decoded = check_report(rig);
    CHECK(rig.count(Fate::lost) == decoded.missing);
    CHECK(rig.line.report().lost_unplugged == decoded.missing);
    CHECK(decoded.missing > 300);
}

TEST_CASE("a device that is unplugged from its power comes back in configuration mode") {
    Rig rig(fault("hang_up", "at_frame = 100\nloses_power = true"));
    rig.run_to(UtcTime(10s));
    CHECK_FALSE(rig.bench.machine.is_sampling());
    rig.bench.now += 10s;
    rig.end_hang_up();
    // It boots now, not when it was pulled out.
    CHECK(rig.bench.send({"FE 01", "0A 00"}) == "0A 04 00 0D");
}

TEST_CASE("another unit answers with its own serial number, at once or after the next hang-up") {
    const bool waits = GENERATE(false, true);
    Rig rig(fault("other_unit", "at_frame = 100\nserial_number = \"87654321\"\nwhen_unplugged = " +
                                    std::string(waits ? "true" : "false")) +
            fault("hang_up", "at_s = 6\nseconds = 1"));
    const auto serial = [&rig] {
        rig.bench.now += 1s;
        return rig.bench.send({"FE 00", "83 02", "FE 01", "74 00"});
    };
    rig.run_to(UtcTime(3s));
    CHECK(serial() == (waits ? "74 31 30 0D" : "74 37 38 0D"));
    rig.run_to(UtcTime(10s));
    if (!waits) return;
    rig.end_hang_up();
    CHECK(serial() == "74 37 38 0D");
}

TEST_CASE("changed settings take effect, and the frames follow them") {
    Rig rig(fault("change_settings",
                  "at_frame = 100\noutput_rate_hz = 100\nfilter = \"k512_fc16\"\n"
                  "burst_ctrl = 0x0702"));
    rig.run_to(UtcTime(10s));
    CHECK(rig.bench.machine.is_sampling());
    CHECK(rig.bench.machine.output_rate_hz() == 100);
    REQUIRE(rig.truth.size() > 500);
    CHECK(rig.truth[200].sampling_run == 2);
    CHECK(static_cast<std::uint16_t>(rig.truth[201].values.count - rig.truth[200].values.count) ==
          40);
    CHECK(rig.bytes.size() == 101 * 24 + (rig.truth.size() - 101) * 16);
}

TEST_CASE("a changed baud rate of the device garbles what it sends") {
    Rig rig(fault("change_baud", "at_frame = 100\nbaud = 115200"));
    rig.run_to(UtcTime(2s));
    const std::size_t before = rig.arrived().size();
    REQUIRE(rig.made(FaultKind::change_baud) == 0);
    for (; rig.now < UtcTime(10s);) {
        rig.line.set_speeds(rig.bench.machine.baud(), 460800);
        rig.run_to(rig.now);
    }
    CHECK(rig.bench.machine.baud() == 115200);
    CHECK(rig.bench.machine.is_sampling());
    CHECK(rig.truth.size() > 400);
    // No frame made at the new speed is intact, and the decoder finds none in the bytes.
    CHECK(before < 101);
    CHECK(rig.arrived().size() == 101);
    CHECK(rig.decoded().frames == rig.arrived());
    CHECK(rig.count(Fate::damaged) == static_cast<std::int64_t>(rig.truth.size()) - 101);
}

TEST_CASE("an answer cuts a frame only if the script allows it") {
    for (const bool cuts : {false, true}) {
        Rig rig(cuts ? "answers_cut_frames = true\n" : "");
        rig.run_to(UtcTime(5s));
        rig.receive("02 00 0D");
        const Decoded decoded = check_report(rig);
        CHECK(rig.count(Fate::damaged) == (cuts ? 1 : 0));
        CHECK(decoded.missing == (cuts ? 1 : 0));
        CHECK(rig.line.report().bytes_of_answers == (cuts ? 0 : 4));
    }
}

TEST_CASE("without automatic frames an answer does not wait for a frame") {
    Rig rig("answers_cut_frames = true\n");
    rig.bench.send({"FE 00", "83 02", "FE 01", "88 00", "FE 00", "83 01"});  // UART_AUTO = 0.
    rig.run_to(UtcTime(5s));
    rig.receive("02 00 0D");
    CHECK_FALSE(rig.line.is_empty());
    rig.run_to(UtcTime(6s));
    CHECK(hex_of(rig.bytes) == "02 00 00 0D");
}

TEST_CASE("an answer that waits for a frame is sent without one when sampling ends") {
    Rig rig("answers_cut_frames = true\n");
    rig.run_to(UtcTime(5s));
    const std::size_t before = rig.bytes.size();
    rig.receive("02 00 0D");
    REQUIRE(rig.line.is_empty());
    rig.receive("FE 00 0D 83 02 0D");
    std::string expected = "02 00 00 0D";
    SECTION("by itself") {}
    SECTION("ahead of the next answer") {
        rig.receive("02 00 0D");
        expected += " 02 04 00 0D";
    }
    rig.run_to(UtcTime(6s));
    CHECK(hex_of(std::span(rig.bytes).subspan(before)) == expected);
    CHECK(rig.count(Fate::damaged) == 0);
}

TEST_CASE("if two faults of the line overlap, the line recovers at the later end") {
    const auto kind = GENERATE("silence", "stall", "overrun", "hang_up");
    CAPTURE(kind);
    Rig rig(fault(kind, "at_s = 2\nseconds = 6") + fault(kind, "at_s = 3\nseconds = 1"));
    const auto heard_by = [&rig](UtcTime end) {
        rig.run_to(end);
        return rig.bytes.size();
    };
    const std::size_t before = heard_by(UtcTime(3500ms));
    const std::size_t after = heard_by(UtcTime(7500ms));
    const UtcTime until = UtcTime(8s);
    if (kind == std::string("overrun")) {
        CHECK(rig.faults.is_overrun(until - 200ms));
        CHECK_FALSE(rig.faults.is_overrun(until + 200ms));
    } else {
        CHECK(after == before);
    }
    if (kind == std::string("hang_up")) CHECK(rig.faults.take_hang_up()->until > until - 200ms);
    if (kind == std::string("silence")) CHECK(heard_by(UtcTime(9s)) > after);
}

TEST_CASE("a frame gets one fault, and the next frame the next fault") {
    Rig rig(fault("flip_bit", "at_frame = 100") + fault("lose_frames", "at_frame = 100") +
            fault("duplicate_frame", "at_frame = 100"));
    check_report(rig);
    CHECK(rig.truth[100].fate == Fate::damaged);
    CHECK(rig.truth[101].fate == Fate::lost);
    CHECK(rig.truth[102].fate == Fate::intact);
    CHECK(rig.truth[103].fate == Fate::repeated);
}

TEST_CASE("random faults follow their rates and depend only on the seed") {
    const std::string toml =
        "[random]\nseed = 3\nflip_bit_per_h = 3600\ndrop_bytes_per_h = 1800\n"
        "duplicate_frame_per_h = 900\ngarbage_per_h = 900\n";
    Rig rig(toml), again(toml);
    rig.run_to(UtcTime(1000s));
    again.run_to(UtcTime(1000s));
    CHECK(rig.bytes == again.bytes);
    const auto count = [&rig](FaultKind kind) { return static_cast<double>(rig.made(kind)); };
    // Poisson: five sigma.
    CHECK(count(FaultKind::flip_bit) == Approx(1000).margin(5 * std::sqrt(1000.0)));
    CHECK(count(FaultKind::drop_bytes) == Approx(500).margin(5 * std::sqrt(500.0)));
    CHECK(count(FaultKind::duplicate_frame) == Approx(250).margin(5 * std::sqrt(250.0)));
    check_report(rig);
}

TEST_CASE("random faults that find no frame in time are refused and counted") {
    Rig rig("[random]\nflip_bit_per_h = 1e6\ndrop_bytes_per_h = 1e6\ncounter_jump_per_h = 1e6\n");
    check_report(rig);
    rig.run_to(UtcTime(60s));
    const FaultReport& report = rig.faults.report();
    const auto frames = static_cast<std::int64_t>(rig.truth.size());
    // Poisson: five sigma.
    const double due = 3 * 1e6 / 60;
    CHECK(static_cast<double>(report.applied_in_all + report.refused_in_all) ==
          Approx(due).margin(5 * std::sqrt(due)));
    CHECK(report.refused_in_all > 0);
    CHECK(report.applied.size() == FaultReport::kMostListed);
    REQUIRE(report.refused.size() == FaultReport::kMostListed);
    CHECK(report.refused[0].reason.ends_with(": too many faults wait for a frame; allowed: 1000"));
    // Every frame has a fault; the rest of those applied waits.
    const std::int64_t of_frames = rig.made(FaultKind::flip_bit) + rig.made(FaultKind::drop_bytes);
    CHECK(of_frames == frames);
    CHECK(rig.count(Fate::damaged) == frames);
    const std::int64_t waiting =
        report.applied_in_all - of_frames - rig.made(FaultKind::counter_jump);
    CHECK(waiting > 0);
    CHECK(waiting <= static_cast<std::int64_t>(FaultInjector::kMostWaiting));
}

TEST_CASE("faults with extremely low rates do not happen, and times do not overflow") {
    const std::string rate = GENERATE("none", "1e-9", "1e-300", "5e-324");
    CAPTURE(rate);
    Rig rig(rate == "none" ? "" : "[random]\nflip_bit_per_h = " + rate + "\n");
    CHECK(check_report(rig).bytes_skipped == 0);
    CHECK(rig.truth.size() > 1400);
    CHECK(rig.count(Fate::intact) == static_cast<std::int64_t>(rig.truth.size()));
    CHECK(later_by(1e300, UtcTime(0s)) == UtcTime::max());
    CHECK(later_by(1.0, UtcTime::max() - 100ms) == UtcTime::max());
    CHECK(later_by(1.0, UtcTime(1s)) == UtcTime(2s));
}

TEST_CASE("faults of the oven are passed on to it, and reported if they cannot be applied") {
    Rig rig(fault("oven_silence", "at_s = 1\ncount = -1") + fault("oven_silence", "at_s = 4"));
    rig.run_to(UtcTime(3s));
    CHECK(rig.oven == "oven_silence -1");
    rig.oven_trouble = "the link is taken";
    check_report(rig);
    REQUIRE(rig.faults.report().refused.size() == 1);
    CHECK(rig.faults.report().refused[0].name == "oven_silence");
    CHECK(rig.faults.report().refused[0].reason == rig.oven_trouble);
    CHECK(rig.faults.report().applied.size() == 1);
    FaultInjector alone({}, UtcTime(0s), rig.line, rig.bench.machine, rig.rules.profile, {}, {});
    CHECK_THROWS_AS(alone.apply(parse_fault("oven_silence", rig.rules), UtcTime(0s)), InputError);
}
