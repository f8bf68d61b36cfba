#include "sim/device/device_stream.hpp"

#include "tests/support/catch.hpp"

#include "protocol/wire/burst_decoder.hpp"
#include "sim/signal/signal_source.hpp"
#include "tests/unit/sim/device/machine_script.hpp"

using namespace a351;
using namespace a351::sim;
using namespace a351::sim::device;
using namespace a351::sim::scenario;
using namespace a351::sim::signal;
using namespace std::chrono_literals;

namespace {

struct Rig {
    void advance_to(UtcTime simulated) { stream.advance_to({simulated, bench.now}, line); }
    void receive(std::string_view hex) {
        stream.receive(bytes_of(hex), {scenario.start(), bench.now}, line);
    }

    Scenario scenario = load_scenario("tsukuba");
    signal::Source source{scenario, *wire::find_profile("A352AD10"), 1};
    Bench bench;
    DeviceStream stream{source, bench.machine};
    Collected line;
};

std::vector<wire::BurstValues> decode(const std::vector<std::byte>& bytes) {
    wire::BurstDecoder decoder(wire::BurstLayout::recommended(), 80);
    std::span<const std::byte> input(bytes);
    std::vector<wire::BurstValues> frames;
    while (const auto event = decoder.next(input)) {
        REQUIRE(std::holds_alternative<wire::BurstFrame>(*event));
        frames.push_back(std::get<wire::BurstFrame>(*event).values());
    }
    return frames;
}

}  // namespace

TEST_CASE("frames are sent when they are due, decode to the truth, and COUNT advances evenly") {
    Rig rig;
    rig.bench.start_logging();
    const UtcTime start = rig.scenario.start();
    const Nanoseconds delay = rig.bench.machine.frame_delay();
    // Seven samples fill the filter; the eighth belongs to 140 ms.
    rig.advance_to(start + 140ms + delay - 1ns);
    CHECK(rig.line.bytes.empty());
    rig.advance_to(start + 140ms + delay);
    CHECK(rig.line.bytes.size() == 24);
    rig.advance_to(start + 10s);
    const auto& truth = rig.line.truth;
    const auto frames = decode(rig.line.bytes);
    REQUIRE(frames.size() == truth.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        CHECK(frames[i] == truth[i].values);
        CHECK(frames[i].count == 80 * (i + 1));
        CHECK(truth[i].grid_index == i + 7);
        CHECK(truth[i].utc == start + static_cast<std::int64_t>(i + 7) * 20ms);
        CHECK(rig.line.times[i] == truth[i].utc + delay);
    }
}

TEST_CASE("a device far behind catches up in pieces and answers commands between them") {
    Rig rig;
    rig.bench.start_logging();
    const UtcTime end = rig.scenario.start() + 1h;
    rig.advance_to(end);
    const std::size_t piece = rig.line.truth.size();
    CHECK(piece < 2000);
    rig.receive("FE 00 0D 83 02 0D");  // Stops sampling.
    rig.advance_to(end);
    CHECK(rig.line.truth.size() == piece);
    REQUIRE(rig.stream.next_due());
    CHECK(*rig.stream.next_due() < end);  // Samples that are not sent also take their pieces.
    while (*rig.stream.next_due() <= end) rig.advance_to(end);
    CHECK(*rig.stream.next_due() == end + 20ms);
}

TEST_CASE("the sample grid continues while sampling is stopped") {
    Rig rig, undisturbed;
    undisturbed.bench.start_logging();
    rig.bench.start_logging();
    const UtcTime start = rig.scenario.start();
    rig.advance_to(start + 10s);
    rig.receive("FE 00 0D 83 02 0D");
    const std::size_t first_run = rig.line.truth.size();
    rig.advance_to(start + 20s);
    CHECK(rig.line.truth.size() == first_run);
    rig.receive("02 00 0D");  // Answered at once.
    CHECK(hex_of(std::span(rig.line.bytes).last(4)) == "02 04 00 0D");
    rig.receive("83 01 0D");
    rig.advance_to(start + 30s);
    undisturbed.advance_to(start + 30s);

    REQUIRE(rig.line.truth.size() > first_run);
    // Samples after the command: index 1001 is the first, seven fill the filter.
    const truth::Record& restarted = rig.line.truth[first_run];
    CHECK(restarted.grid_index == 1008);
    CHECK(restarted.values.count == 80);
    CHECK(restarted.sampling_run == 2);
    CHECK(restarted.values.axes == undisturbed.line.truth[1008 - 7].values.axes);
}

TEST_CASE("an output rate above the grid's repeats each sample") {
    Rig rig;
    rig.bench.send({"FE 01", "85 04", "86 08", "88 01", "8C 03", "8D C7", "FE 00", "83 01"});
    rig.advance_to(rig.scenario.start() + 2s);
    const auto& truth = rig.line.truth;
    REQUIRE(truth.size() > 300);
    for (std::size_t i = 1; i < truth.size(); ++i) {
        REQUIRE(truth[i].utc - truth[i - 1].utc == 5ms);
        REQUIRE(truth[i].values.count == 20 * (i + 1));
        REQUIRE(truth[i].grid_index == (i + 31) / 4);
    }
}

TEST_CASE("after a stop between repeats of a sample a lower rate is on time from its first frame") {
    // Stopped at 1000/s with 15 of 20 repeats sent, started again at 50/s before the next sample.
    GridSource source(50, [](std::int64_t) { return kSample; });
    Bench bench;
    DeviceStream stream(source, bench.machine);
    Collected line;
    const auto receive = [&](std::string_view hex, UtcTime now) {
        stream.receive(bytes_of(hex), {now, bench.now}, line);
    };
    bench.send({"FE 01", "85 02", "86 0B", "88 01", "8C 03", "8D C7", "FE 00", "83 01"});
    const UtcTime stop = UtcTime(1s + 15ms);
    stream.advance_to({stop, bench.now}, line);
    const std::size_t first_run = line.truth.size();
    REQUIRE(first_run > 1000);
    receive("83 02 0D FE 01 0D 85 06 0D FE 00 0D 83 01 0D", stop);
    REQUIRE(stream.next_due() == UtcTime(1s + 20ms) + bench.machine.frame_delay());
    for (UtcTime now = stop; now < UtcTime(3s); now += 1ms) {
        const std::size_t before = line.truth.size();
        stream.advance_to({now, bench.now}, line);
        REQUIRE(line.truth.size() - before <= 1);
    }
    REQUIRE(line.truth.size() > first_run + 90);
    for (std::size_t i = first_run; i < line.truth.size(); ++i) {
        const auto nth = static_cast<std::int64_t>(i - first_run);
        CHECK(line.truth[i].utc == UtcTime(1s + 20ms + nth * 20ms));
        CHECK(line.truth[i].grid_index == 51 + nth);
        CHECK(line.truth[i].values.count == 80 * (nth + 1));
    }
}
