#include "sim/line/fault_injector.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <map>

#include "protocol/core/input_error.hpp"
#include "protocol/timing/sample_index.hpp"
#include "protocol/wire/burst_decoder.hpp"
#include "sim/device/device_stream.hpp"
#include "sim/noise/random.hpp"
#include "tests/unit/sim/device/machine_script.hpp"

using namespace a351;
using namespace a351::sim;
using namespace std::chrono_literals;
using Kind = timing::Placement::Kind;

namespace {

/// Noise, without end.
class NoiseSource final : public SampleSource {
public:
    [[nodiscard]] int rate_hz() const noexcept override { return 50; }
    [[nodiscard]] std::optional<UtcTime> next_instant() const override {
        return UtcTime(index_ * 20ms);
    }
    [[nodiscard]] TimedSample next() override {
        TimedSample sample{*next_instant(), index_++, {}};
        for (std::int32_t& axis : sample.values.axes_counts) axis = draw();
        sample.values.temperature_counts = draw();
        return sample;
    }

private:
    std::int32_t draw() { return static_cast<std::int32_t>(noise_.bits() >> 44U); }
    std::int64_t index_ = 0;
    RandomStream noise_{1, "test"};
};

/// What a host makes of the bytes.
struct Heard {
    std::vector<wire::BurstValues> frames;
    std::map<Kind, int> places;
    std::int64_t missing = 0;
    std::size_t bytes_skipped = 0;
};

struct Rig {
    explicit Rig(const std::string& toml)
        : faults(parse_fault_script(toml, "script.toml", UtcTime(0s), rules), UtcTime(0s), line,
                 bench.machine, rules.profile, {}, [this](std::string_view kind, int count) {
                     oven = std::string(kind) + " " + std::to_string(count);
                     return true;
                 }) {
        bench.start_logging();
    }

    void run_to(UtcTime end) {
        for (; now <= end; now += 100ms) {
            const Instant instant{now, bench.now};
            faults.begin(instant);
            stream.advance_to(instant, faults);
            faults.catch_up(instant);
            const auto shown = line.shown(now);
            bytes.insert(bytes.end(), shown.begin(), shown.end());
            line.handed_over(shown.size(), now);
        }
    }

    [[nodiscard]] Heard heard() const {
        Heard heard;
        wire::BurstDecoder decoder(wire::BurstLayout::recommended(), 80);
        timing::SampleIndex index(80, Hertz(50));
        std::span<const std::byte> input(bytes);
        while (const auto event = decoder.next(input)) {
            if (const auto* lost = std::get_if<wire::Discarded>(&*event)) {
                heard.bytes_skipped += lost->byte_count;
                continue;
            }
            const auto& values = std::get<wire::BurstFrame>(*event).values();
            heard.frames.push_back(values);
            const RawTime arrival(static_cast<std::int64_t>(heard.frames.size()) * 20ms);
            auto place = index.place(values.count, true, arrival);
            ++heard.places[place.kind];
            heard.missing += place.missing;
            if (place.kind != Kind::new_session) continue;
            index = timing::SampleIndex(80, Hertz(50));
            static_cast<void>(index.place(values.count, true, arrival));
        }
        heard.bytes_skipped += decoder.pending_bytes();
        return heard;
    }

    [[nodiscard]] std::vector<wire::BurstValues> arrived() const {
        std::vector<wire::BurstValues> values;
        for (const TruthRecord& record : truth) {
            if (record.fate != Fate::damaged && record.fate != Fate::lost) {
                values.push_back(record.values);
            }
        }
        return values;
    }

    [[nodiscard]] std::int64_t count(Fate fate) const {
        return std::ranges::count(truth, fate, &TruthRecord::fate);
    }

    FaultRules rules{*wire::find_profile("A352AD10"), 1.0, {"oven_silence"}};
    NoiseSource source;
    Bench bench;
    DeviceStream stream{source, bench.machine};
    std::vector<TruthRecord> truth;
    Line line{{}, 1, UtcTime(0s), [this](const TruthRecord& record) { truth.push_back(record); }};
    FaultInjector faults;
    UtcTime now{0s};
    std::vector<std::byte> bytes;
    std::string oven;
};

std::string fault(const std::string& kind, const std::string& keys) {
    return "[[fault]]\nkind = \"" + kind + "\"\n" + keys + "\n";
}

/// Frames before, fault, frames behind; what the emulator says is what a host finds.
Heard check_report(Rig& rig) {
    rig.run_to(UtcTime(30s));
    const Heard heard = rig.heard();
    const LineReport& report = rig.line.report();
    CHECK(heard.frames == rig.arrived());
    CHECK(static_cast<std::int64_t>(heard.frames.size()) == report.frames_sent);
    CHECK(static_cast<std::int64_t>(heard.bytes_skipped) ==
          report.bytes_handed_over - report.bytes_of_frames);
    CHECK(report.bytes_handed_over == static_cast<std::int64_t>(rig.bytes.size()));
    CHECK(report.frames_damaged == rig.count(Fate::damaged));
    CHECK(report.frames_lost == rig.count(Fate::lost));
    CHECK(report.frames_repeated == rig.count(Fate::repeated));
    CHECK(report.frames_misplaced == rig.count(Fate::misplaced));
    return heard;
}

}  // namespace

TEST_CASE("an empty script changes no byte", "[sim][fault]") {
    Rig rig("");
    const Heard heard = check_report(rig);
    CHECK(heard.bytes_skipped == 0);
    CHECK(rig.truth.size() > 1400);
    CHECK(rig.count(Fate::intact) == static_cast<std::int64_t>(rig.truth.size()));
}

TEST_CASE("a frame with any number of bits flipped is rejected, and it alone", "[sim][fault]") {
    const int bits = GENERATE(1, 2, 3, 8, 16);
    Rig rig(fault("flip_bit", "at_frame = 100\ncount = 200\nbits = " + std::to_string(bits)));
    const Heard heard = check_report(rig);
    CHECK(rig.count(Fate::damaged) == 200);
    CHECK(heard.bytes_skipped == 200 * 24);
    CHECK(heard.missing == 200);
    CHECK(rig.truth[99].fate == Fate::intact);
    CHECK(rig.truth[100].fate == Fate::damaged);
    CHECK(rig.truth[299].fate == Fate::damaged);
    CHECK(rig.truth[300].fate == Fate::intact);
}

TEST_CASE("a bad checksum is a bad checksum and nothing else", "[sim][fault]") {
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

TEST_CASE("dropped, inserted and missing bytes cost the frame they are in", "[sim][fault]") {
    const std::string kind = GENERATE("drop_bytes", "insert_bytes", "truncate_frame");
    const int bytes = GENERATE(1, 2, 7, 100);
    CAPTURE(kind, bytes);
    const std::string keys = "at_frame = 100\ncount = 300\n";
    Rig rig(
        fault(kind, kind == "truncate_frame" ? keys : keys + "bytes = " + std::to_string(bytes)));
    const Heard heard = check_report(rig);
    CHECK(rig.count(Fate::damaged) == 300);
    CHECK(heard.missing == 300);
    const FaultReport& report = rig.faults.report();
    CHECK(static_cast<std::int64_t>(heard.bytes_skipped) ==
          300 * 24 + report.bytes_inserted - report.bytes_dropped);
    if (kind == "drop_bytes") CHECK(report.bytes_dropped == 300 * std::min(bytes, 23));
    if (kind == "insert_bytes") CHECK(report.bytes_inserted == 300 * bytes);
}

TEST_CASE("garbage costs no frame", "[sim][fault]") {
    const int bytes = GENERATE(1, 23, 24, 10'000);
    Rig rig(fault("garbage", "at_s = 5\ncount = 20\nbytes = " + std::to_string(bytes)));
    const Heard heard = check_report(rig);
    CHECK(heard.bytes_skipped == static_cast<std::size_t>(20 * bytes));
    CHECK(heard.missing == 0);
    CHECK(rig.faults.report().bytes_garbage == 20 * bytes);
    CHECK(rig.count(Fate::intact) == static_cast<std::int64_t>(rig.truth.size()));
}

TEST_CASE("a second copy is a duplicate", "[sim][fault]") {
    Rig rig(fault("duplicate_frame", "at_frame = 100\ncount = 10"));
    Heard heard = check_report(rig);
    CHECK(heard.places[Kind::duplicate] == 10);
    CHECK(heard.missing == 0);
    CHECK(rig.truth[101].fate == Fate::repeated);
    CHECK(rig.truth[101].values == rig.truth[100].values);
    CHECK(rig.truth[101].utc == rig.truth[100].utc);
    CHECK(rig.line.report().frames_made == rig.line.report().frames_sent - 10);
}

TEST_CASE("frames that change places leave a gap and an anomaly", "[sim][fault]") {
    Rig rig(fault("reorder_frames", "at_frame = 100\ncount = 2"));
    Heard heard = check_report(rig);
    CHECK(heard.places[Kind::anomaly] == 2);
    CHECK(heard.places[Kind::after_gap] == 2);
    CHECK(heard.missing == 2);
    CHECK(rig.truth[101].fate == Fate::misplaced);
    CHECK(rig.truth[101].utc + 20ms == rig.truth[100].utc);
}

TEST_CASE("lost frames are a gap of their number", "[sim][fault]") {
    const int count = GENERATE(1, 5, 700);
    Rig rig(fault("lose_frames", "at_frame = 100\ncount = " + std::to_string(count)));
    Heard heard = check_report(rig);
    CHECK(heard.missing == count);
    CHECK(heard.places[Kind::after_gap] == 1);
    CHECK(heard.bytes_skipped == 0);
    CHECK(rig.count(Fate::lost) == count);
}

TEST_CASE("a counter that jumps by whole samples is a gap, by others an anomaly and a new session",
          "[sim][fault]") {
    const int count = GENERATE(1, 10, 400);
    Rig whole(fault("counter_jump", "at_frame = 100\ncount = " + std::to_string(count)));
    CHECK(check_report(whole).missing == count);
    CHECK(whole.count(Fate::misplaced) == 0);
    Rig part(fault("counter_jump", "at_frame = 100\nticks = 7"));
    Heard heard = check_report(part);
    CHECK(heard.places[Kind::anomaly] == 1);
    CHECK(heard.places[Kind::new_session] == 1);
    CHECK(part.truth[101].fate == Fate::misplaced);
    CHECK(part.count(Fate::misplaced) == 1);
}

TEST_CASE("a counter that stands still repeats itself and is right afterwards", "[sim][fault]") {
    const int count = GENERATE(1, 2, 30);
    Rig rig(fault("counter_stuck", "at_frame = 100\ncount = " + std::to_string(count)));
    Heard heard = check_report(rig);
    CHECK(heard.places[Kind::duplicate] == count);
    CHECK(heard.missing == count);
    CHECK(rig.count(Fate::repeated) == count);
    const auto last = static_cast<std::size_t>(100 + count);
    CHECK(rig.truth[last].values.count == rig.truth[100].values.count);
    CHECK(rig.truth[last + 1].values.count == 80 * (last + 2) % 65536);
}

TEST_CASE("a counter that starts anew is an anomaly, then a new session", "[sim][fault]") {
    Rig rig(fault("counter_reset", "at_frame = 100"));
    Heard heard = check_report(rig);
    CHECK(rig.truth[101].values.count == 80);
    CHECK(heard.places[Kind::anomaly] == 1);
    CHECK(heard.places[Kind::new_session] == 1);
}

TEST_CASE("error flags stand in as many frames as asked for", "[sim][fault]") {
    Rig rig(fault("error_flags", "at_frame = 100\ncount = 7\ndiag_stat = 0x20"));
    const Heard heard = check_report(rig);
    for (std::size_t i = 0; i < heard.frames.size(); ++i) {
        REQUIRE((heard.frames[i].flag & wire::kFlagError) == (i > 100 && i <= 107 ? 1 : 0));
    }
    CHECK(rig.line.report().frames_flagged == 7);
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

TEST_CASE("tests fail from the next start-up on until they are healed", "[sim][fault]") {
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

TEST_CASE("a silent device goes on counting", "[sim][fault]") {
    Rig rig(fault("silence", "at_frame = 100\nseconds = 4"));
    Heard heard = check_report(rig);
    CHECK(heard.missing == 200);
    CHECK(rig.count(Fate::lost) == 200);
    CHECK(heard.places[Kind::after_gap] == 1);
}

TEST_CASE("a stall brings everything late and in one burst", "[sim][fault]") {
    Rig rig(fault("stall", "at_frame = 100\nseconds = 4"));
    rig.run_to(UtcTime(6s));
    CHECK(rig.truth.size() == 100);
    const Heard heard = check_report(rig);
    CHECK(heard.missing == 0);
    CHECK(heard.bytes_skipped == 0);
}

TEST_CASE("a port that is pulled out loses what was under way", "[sim][fault]") {
    Rig rig(fault("hang_up", "at_frame = 100\nseconds = 4"));
    rig.run_to(UtcTime(10s));
    const auto hang_up = rig.faults.take_hang_up();
    REQUIRE(hang_up);
    CHECK_FALSE(rig.faults.take_hang_up());
    CHECK(hang_up->until - rig.faults.report().applied.at(0).at == 4s);
    rig.faults.came_back(*hang_up, {rig.now, rig.bench.now});
    Heard heard = check_report(rig);
    CHECK(rig.count(Fate::lost) == heard.missing);
    CHECK(rig.line.report().lost_unplugged == heard.missing);
    CHECK(heard.missing > 300);
}

TEST_CASE("pulled out without power, the device comes back in configuration mode", "[sim][fault]") {
    Rig rig(fault("hang_up", "at_frame = 100\nloses_power = true"));
    rig.run_to(UtcTime(10s));
    CHECK_FALSE(rig.bench.machine.is_sampling());
    const auto hang_up = rig.faults.take_hang_up();
    REQUIRE(hang_up);
    rig.bench.now += 10s;
    rig.faults.came_back(*hang_up, {rig.now, rig.bench.now});
    // It boots now, not when it was pulled out.
    CHECK(rig.bench.send({"FE 01", "0A 00"}) == "0A 04 00 0D");
}

TEST_CASE("another unit answers with its own number, at once or after the next hang-up",
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
    rig.faults.came_back(*hang_up, {rig.now, rig.bench.now});
    CHECK(serial() == "74 37 38 0D");
}

TEST_CASE("other settings come as asked for, and frames with them", "[sim][fault]") {
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

TEST_CASE("another speed of the device garbles what it sends", "[sim][fault]") {
    Rig rig(fault("change_baud", "at_frame = 100\nbaud = 115200"));
    rig.run_to(UtcTime(10s));
    CHECK(rig.bench.machine.baud() == 115200);
    CHECK(rig.bench.machine.is_sampling());
}

TEST_CASE("answers may cut a frame if asked to", "[sim][fault]") {
    for (const bool cuts : {false, true}) {
        Rig rig(cuts ? "answers_cut_frames = true\n" : "");
        rig.run_to(UtcTime(5s));
        rig.stream.receive(bytes_of("02 00 0D"), {rig.now, rig.bench.now}, rig.faults);
        const Heard heard = check_report(rig);
        CHECK(rig.count(Fate::damaged) == (cuts ? 1 : 0));
        CHECK(heard.missing == (cuts ? 1 : 0));
        CHECK(rig.line.report().bytes_of_answers == (cuts ? 0 : 4));
    }
}

TEST_CASE("a frame suffers one fault, and the next one the next", "[sim][fault]") {
    Rig rig(fault("flip_bit", "at_frame = 100") + fault("lose_frames", "at_frame = 100") +
            fault("duplicate_frame", "at_frame = 100"));
    check_report(rig);
    CHECK(rig.truth[100].fate == Fate::damaged);
    CHECK(rig.truth[101].fate == Fate::lost);
    CHECK(rig.truth[102].fate == Fate::intact);
    CHECK(rig.truth[103].fate == Fate::repeated);
}

TEST_CASE("random faults follow their rates, and the seed alone", "[sim][fault]") {
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

TEST_CASE("faults of the oven are handed on, unknown ones refused", "[sim][fault]") {
    Rig rig(fault("oven_silence", "at_s = 1\ncount = -1"));
    rig.run_to(UtcTime(3s));
    CHECK(rig.oven == "oven_silence -1");
    FaultInjector alone({}, UtcTime(0s), rig.line, rig.bench.machine, rig.rules.profile, {}, {});
    CHECK_THROWS_AS(alone.apply(parse_fault("oven_silence", rig.rules), UtcTime(0s)), InputError);
}

TEST_CASE("a fault in time happens without frames too", "[sim][fault]") {
    Rig rig(fault("stop", "at_s = 2") + fault("power_cycle", "at_s = 4"));
    rig.run_to(UtcTime(3s));
    CHECK_FALSE(rig.bench.machine.is_sampling());
    rig.run_to(UtcTime(5s));
    REQUIRE(rig.faults.report().applied.size() == 2);
    CHECK(rig.faults.report().applied[1].at == UtcTime(4s));
}
