#include "sim/line/fault_injector.hpp"

#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"
#include "tests/unit/sim/line/fault_rig.hpp"

using namespace a351;
using namespace a351::sim::device;
using namespace a351::sim::line;
using namespace a351::sim::truth;

TEST_CASE("an empty script changes no byte", "[sim][fault]") {
    Rig rig("");
    const Decoded decoded = check_report(rig);
    CHECK(decoded.bytes_skipped == 0);
    CHECK(rig.truth.size() > 1400);
    CHECK(rig.count(Fate::intact) == static_cast<std::int64_t>(rig.truth.size()));
}

TEST_CASE("a frame with any number of flipped bits is rejected, and no other frame",
          "[sim][fault]") {
    const int bits = GENERATE(1, 2, 3, 8, 16);
    Rig rig(fault("flip_bit", "at_frame = 100\ncount = 200\nbits = " + std::to_string(bits)));
    const Decoded decoded = check_report(rig);
    CHECK(rig.count(Fate::damaged) == 200);
    CHECK(decoded.bytes_skipped == 200 * 24);
    CHECK(decoded.missing == 200);
    CHECK(rig.truth[99].fate == Fate::intact);
    CHECK(rig.truth[100].fate == Fate::damaged);
    CHECK(rig.truth[299].fate == Fate::damaged);
    CHECK(rig.truth[300].fate == Fate::intact);
}

TEST_CASE("a bad checksum is found as a bad checksum and as nothing else", "[sim][fault]") {
    Rig rig(fault("bad_checksum", "at_frame = 50\ncount = 3"));
    check_report(rig);
    wire::BurstDecoder decoder(wire::BurstLayout::recommended(), 80);
    std::span<const std::byte> input(rig.bytes);
    int bad_checksums = 0;
    while (const auto event = decoder.next(input)) {
        const auto* lost = std::get_if<wire::Discarded>(&*event);
        if (lost == nullptr) continue;
        CHECK(lost->reason == wire::Discarded::Reason::bad_checksum);
        CHECK(lost->byte_count == 24);
        ++bad_checksums;
    }
    CHECK(bad_checksums == 3);
}

TEST_CASE("dropped, inserted and missing bytes cost only the frame they are in", "[sim][fault]") {
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

TEST_CASE("garbage between frames costs no frame", "[sim][fault]") {
    const int bytes = GENERATE(1, 23, 24, 10'000);
    Rig rig(fault("garbage", "at_s = 5\ncount = 20\nbytes = " + std::to_string(bytes)));
    const Decoded decoded = check_report(rig);
    CHECK(decoded.bytes_skipped == static_cast<std::size_t>(20 * bytes));
    CHECK(decoded.missing == 0);
    CHECK(rig.faults.report().bytes_garbage == 20 * bytes);
    CHECK(rig.count(Fate::intact) == static_cast<std::int64_t>(rig.truth.size()));
}

TEST_CASE("a second copy of a frame is a duplicate", "[sim][fault]") {
    Rig rig(fault("duplicate_frame", "at_frame = 100\ncount = 10"));
    Decoded decoded = check_report(rig);
    CHECK(decoded.places[Kind::duplicate] == 10);
    CHECK(decoded.missing == 0);
    CHECK(rig.truth[101].fate == Fate::repeated);
    CHECK(rig.truth[101].values == rig.truth[100].values);
    CHECK(rig.truth[101].utc == rig.truth[100].utc);
    CHECK(rig.line.report().frames_made == rig.line.report().frames_sent - 10);
}

TEST_CASE("two frames in exchanged order show as one gap and one anomaly", "[sim][fault]") {
    Rig rig(fault("reorder_frames", "at_frame = 100\ncount = 2"));
    Decoded decoded = check_report(rig);
    CHECK(decoded.places[Kind::anomaly] == 2);
    CHECK(decoded.places[Kind::after_gap] == 2);
    CHECK(decoded.missing == 2);
    CHECK(rig.truth[101].fate == Fate::misplaced);
    CHECK(rig.truth[101].utc + 20ms == rig.truth[100].utc);
}

TEST_CASE("lost frames are one gap of as many samples", "[sim][fault]") {
    const int count = GENERATE(1, 5, 700);
    Rig rig(fault("lose_frames", "at_frame = 100\ncount = " + std::to_string(count)));
    Decoded decoded = check_report(rig);
    CHECK(decoded.missing == count);
    CHECK(decoded.places[Kind::after_gap] == 1);
    CHECK(decoded.bytes_skipped == 0);
    CHECK(rig.count(Fate::lost) == count);
}

TEST_CASE("a reset, a power cut and a stop end the stream in configuration mode", "[sim][fault]") {
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

TEST_CASE("self tests fail from the next start-up on until the device is repaired",
          "[sim][fault]") {
    Rig rig(fault("failing_tests", "at_frame = 50\ndiag_stat = 0x20") +
            fault("power_cycle", "at_frame = 100"));
    check_report(rig);
    const auto diagnostics_after_start = [&rig] {
        rig.bench.now += 1s;
        return rig.bench.send({"FE 00", "04 00"});
    };
    CHECK(diagnostics_after_start() == "04 00 20 0D");
    rig.bench.machine.fail_tests(0);
    rig.bench.machine.power_cycle(rig.bench.now);
    CHECK(diagnostics_after_start() == "04 00 00 0D");
}

TEST_CASE("a silent device continues to count", "[sim][fault]") {
    Rig rig(fault("silence", "at_frame = 100\nseconds = 4"));
    Decoded decoded = check_report(rig);
    CHECK(decoded.missing == 200);
    CHECK(rig.count(Fate::lost) == 200);
    CHECK(decoded.places[Kind::after_gap] == 1);
}

TEST_CASE("after a stall everything arrives late and in one burst", "[sim][fault]") {
    Rig rig(fault("stall", "at_frame = 100\nseconds = 4"));
    rig.run_to(UtcTime(6s));
    CHECK(rig.truth.size() == 100);
    const Decoded decoded = check_report(rig);
    CHECK(decoded.missing == 0);
    CHECK(decoded.bytes_skipped == 0);
}

TEST_CASE("unplugging a port loses the frames until it is back", "[sim][fault]") {
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

TEST_CASE("a device that is unplugged from its power comes back in configuration mode",
          "[sim][fault]") {
    Rig rig(fault("hang_up", "at_frame = 100\nloses_power = true"));
    rig.run_to(UtcTime(10s));
    CHECK_FALSE(rig.bench.machine.is_sampling());
    const auto hang_up = rig.faults.take_hang_up();
    REQUIRE(hang_up);
    rig.bench.now += 10s;
    rig.faults.end_hang_up(*hang_up, {rig.now, rig.bench.now});
    // It boots now, not when it was pulled out.
    CHECK(rig.bench.send({"FE 01", "0A 00"}) == "0A 04 00 0D");
}

TEST_CASE("another unit answers with its own serial number, at once or after the next hang-up",
          "[sim][fault]") {
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
    const auto hang_up = rig.faults.take_hang_up();
    REQUIRE(hang_up);
    rig.faults.end_hang_up(*hang_up, {rig.now, rig.bench.now});
    CHECK(serial() == "74 37 38 0D");
}

TEST_CASE("changed settings take effect, and the frames follow them", "[sim][fault]") {
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

TEST_CASE("a changed baud rate of the device garbles what it sends", "[sim][fault]") {
    Rig rig(fault("change_baud", "at_frame = 100\nbaud = 115200"));
    rig.run_to(UtcTime(2s));
    const std::size_t before = rig.arrived().size();
    REQUIRE(rig.faults.report().by_kind[static_cast<std::size_t>(FaultKind::change_baud)] == 0);
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

TEST_CASE("an answer cuts a frame only if the script allows it", "[sim][fault]") {
    for (const bool cuts : {false, true}) {
        Rig rig(cuts ? "answers_cut_frames = true\n" : "");
        rig.run_to(UtcTime(5s));
        rig.stream.receive(bytes_of("02 00 0D"), {rig.now, rig.bench.now}, rig.faults);
        const Decoded decoded = check_report(rig);
        CHECK(rig.count(Fate::damaged) == (cuts ? 1 : 0));
        CHECK(decoded.missing == (cuts ? 1 : 0));
        CHECK(rig.line.report().bytes_of_answers == (cuts ? 0 : 4));
    }
}

TEST_CASE("without automatic frames an answer does not wait for a frame", "[sim][fault]") {
    Rig rig("answers_cut_frames = true\n");
    rig.bench.send({"FE 00", "83 02", "FE 01", "88 00", "FE 00", "83 01"});  // UART_AUTO = 0.
    rig.run_to(UtcTime(5s));
    rig.stream.receive(bytes_of("02 00 0D"), {rig.now, rig.bench.now}, rig.faults);
    CHECK_FALSE(rig.line.is_empty());
    rig.run_to(UtcTime(6s));
    CHECK(hex_of(rig.bytes) == "02 00 00 0D");
}

TEST_CASE("an answer that waits for a frame is sent without one when sampling ends",
          "[sim][fault]") {
    Rig rig("answers_cut_frames = true\n");
    rig.run_to(UtcTime(5s));
    const std::size_t before = rig.bytes.size();
    const auto say = [&rig](std::string_view hex) {
        rig.stream.receive(bytes_of(hex), {rig.now, rig.bench.now}, rig.faults);
    };
    say("02 00 0D");
    REQUIRE(rig.line.is_empty());
    say("FE 00 0D 83 02 0D");
    std::string expected = "02 00 00 0D";
    SECTION("by itself") {}
    SECTION("ahead of the next answer") {
        say("02 00 0D");
        expected += " 02 04 00 0D";
    }
    rig.run_to(UtcTime(6s));
    CHECK(hex_of(std::span(rig.bytes).subspan(before)) == expected);
    CHECK(rig.count(Fate::damaged) == 0);
}

TEST_CASE("if two faults of the line overlap, the line recovers at the later end", "[sim][fault]") {
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

TEST_CASE("a frame gets one fault, and the next frame the next fault", "[sim][fault]") {
    Rig rig(fault("flip_bit", "at_frame = 100") + fault("lose_frames", "at_frame = 100") +
            fault("duplicate_frame", "at_frame = 100"));
    check_report(rig);
    CHECK(rig.truth[100].fate == Fate::damaged);
    CHECK(rig.truth[101].fate == Fate::lost);
    CHECK(rig.truth[102].fate == Fate::intact);
    CHECK(rig.truth[103].fate == Fate::repeated);
}

TEST_CASE("random faults follow their rates and depend only on the seed", "[sim][fault]") {
    const std::string toml =
        "[random]\nseed = 3\nflip_bit_per_h = 3600\ndrop_bytes_per_h = 1800\n"
        "duplicate_frame_per_h = 900\ngarbage_per_h = 900\n";
    Rig rig(toml), again(toml);
    rig.run_to(UtcTime(1000s));
    again.run_to(UtcTime(1000s));
    CHECK(rig.bytes == again.bytes);
    const auto& counts = rig.faults.report().by_kind;
    const auto count = [&counts](FaultKind kind) {
        return static_cast<double>(counts[static_cast<std::size_t>(kind)]);
    };
    // Poisson: five sigma.
    CHECK(count(FaultKind::flip_bit) == Approx(1000).margin(5 * std::sqrt(1000.0)));
    CHECK(count(FaultKind::drop_bytes) == Approx(500).margin(5 * std::sqrt(500.0)));
    CHECK(count(FaultKind::duplicate_frame) == Approx(250).margin(5 * std::sqrt(250.0)));
    check_report(rig);
}

TEST_CASE("random faults that find no frame in time are refused and counted", "[sim][fault]") {
    Rig rig("[random]\nflip_bit_per_h = 1e6\ndrop_bytes_per_h = 1e6\ncounter_jump_per_h = 1e6\n");
    check_report(rig);
    rig.run_to(UtcTime(60s));
    const FaultReport& report = rig.faults.report();
    const auto frames = static_cast<std::int64_t>(rig.truth.size());
    const auto made = [&report](FaultKind kind) {
        return report.by_kind[static_cast<std::size_t>(kind)];
    };
    // Poisson: five sigma.
    const double due = 3 * 1e6 / 60;
    CHECK(static_cast<double>(report.applied_in_all + report.refused_in_all) ==
          Approx(due).margin(5 * std::sqrt(due)));
    CHECK(report.refused_in_all > 0);
    CHECK(report.applied.size() == FaultReport::kMostListed);
    REQUIRE(report.refused.size() == FaultReport::kMostListed);
    CHECK(report.refused[0].reason.ends_with(": too many faults wait for a frame; allowed: 1000"));
    // Every frame has a fault; the rest of those applied waits.
    const std::int64_t of_frames = made(FaultKind::flip_bit) + made(FaultKind::drop_bytes);
    CHECK(of_frames == frames);
    CHECK(rig.count(Fate::damaged) == frames);
    const std::int64_t waiting = report.applied_in_all - of_frames - made(FaultKind::counter_jump);
    CHECK(waiting > 0);
    CHECK(waiting <= static_cast<std::int64_t>(FaultInjector::kMostWaiting));
}

TEST_CASE("faults with extremely low rates do not happen, and times do not overflow",
          "[sim][fault]") {
    const auto rate = GENERATE("1e-9", "1e-300", "5e-324");
    CAPTURE(rate);
    Rig rig("[random]\nflip_bit_per_h = " + std::string(rate) + "\n");
    check_report(rig);
    CHECK(rig.truth.size() > 1400);
    CHECK(rig.count(Fate::intact) == static_cast<std::int64_t>(rig.truth.size()));
    CHECK(later_by(1e300, UtcTime(0s)) == UtcTime::max());
    CHECK(later_by(1.0, UtcTime::max() - 100ms) == UtcTime::max());
    CHECK(later_by(1.0, UtcTime(1s)) == UtcTime(2s));
}

TEST_CASE("a scripted fault that cannot be applied is reported and ends nothing", "[sim][fault]") {
    Rig rig(fault("oven_silence", "at_s = 1"));
    rig.oven_trouble = "the link is taken";
    check_report(rig);
    REQUIRE(rig.faults.report().refused.size() == 1);
    CHECK(rig.faults.report().refused[0].name == "oven_silence");
    CHECK(rig.faults.report().refused[0].reason == rig.oven_trouble);
    CHECK(rig.faults.report().applied.empty());
}

TEST_CASE("faults of the oven are passed on to it, and refused without an oven", "[sim][fault]") {
    Rig rig(fault("oven_silence", "at_s = 1\ncount = -1"));
    rig.run_to(UtcTime(3s));
    CHECK(rig.oven == "oven_silence -1");
    FaultInjector alone({}, UtcTime(0s), rig.line, rig.bench.machine, rig.rules.profile, {}, {});
    CHECK_THROWS_AS(alone.apply(parse_fault("oven_silence", rig.rules), UtcTime(0s)), InputError);
}

TEST_CASE("a fault with a set time happens even without frames", "[sim][fault]") {
    Rig rig(fault("stop", "at_s = 2") + fault("power_cycle", "at_s = 4"));
    rig.run_to(UtcTime(3s));
    CHECK_FALSE(rig.bench.machine.is_sampling());
    rig.run_to(UtcTime(5s));
    REQUIRE(rig.faults.report().applied.size() == 2);
    CHECK(rig.faults.report().applied[1].at == UtcTime(4s));
}
