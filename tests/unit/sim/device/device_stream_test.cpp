#include "sim/device/device_stream.hpp"

#include <catch2/catch.hpp>

#include "protocol/wire/burst_decoder.hpp"
#include "sim/signal/signal_source.hpp"
#include "tests/unit/sim/device/machine_script.hpp"

using namespace a351;
using namespace a351::sim;
using namespace std::chrono_literals;

namespace {

struct Rig {
    Rig() : stream(source, bench.machine, [this](const TruthRecord& r) { truth.push_back(r); }) {}

    /// Hands over whatever is pending, at most `most` bytes.
    void drain(UtcTime now, std::size_t most = SIZE_MAX) {
        const auto bytes = stream.pending();
        const std::size_t count = std::min(most, bytes.size());
        received.insert(received.end(), bytes.begin(),
                        bytes.begin() + static_cast<std::ptrdiff_t>(count));
        stream.handed_over(count, now);
    }

    Scenario scenario = load_scenario("tsukuba");
    SignalSource source{scenario, *wire::find_profile("A352AD10"), 1};
    Bench bench;
    DeviceStream stream;
    std::vector<TruthRecord> truth;
    std::vector<std::byte> received;
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

TEST_CASE("a frame is sent when it is due and not before", "[sim][device_stream]") {
    Rig rig;
    rig.bench.start_logging();
    const UtcTime start = rig.scenario.start();
    const Nanoseconds delay = rig.bench.machine.frame_delay();
    // Seven samples fill the filter; the eighth belongs to 140 ms.
    rig.stream.advance_to(start + 140ms + delay - 1ns);
    CHECK(rig.stream.pending().empty());
    rig.stream.advance_to(start + 140ms + delay);
    CHECK(rig.stream.pending().size() == 24);
    rig.drain(start + 140ms + delay + 3ms);
    REQUIRE(rig.truth.size() == 1);
    CHECK(rig.truth[0].utc == start + 140ms);
    CHECK(rig.truth[0].grid_index == 7);
    CHECK(rig.stream.report().largest_lateness == 3ms);
}

TEST_CASE("a full terminal delays frames and loses none", "[sim][device_stream]") {
    Rig blocked, flowing;
    blocked.bench.start_logging();
    flowing.bench.start_logging();
    const UtcTime start = blocked.scenario.start();
    for (int second = 1; second <= 120; ++second) {
        flowing.stream.advance_to(start + std::chrono::seconds(second));
        flowing.drain(start + std::chrono::seconds(second));
    }
    // Nothing is taken for two minutes, then odd pieces.
    blocked.stream.advance_to(start + 120s);
    CHECK(blocked.stream.pending().size() < DeviceStream::kMostPending + 24);
    while (blocked.received.size() < flowing.received.size()) {
        blocked.drain(start + 120s, 37);
        blocked.stream.advance_to(start + 120s);
    }
    CHECK(blocked.received == flowing.received);
    CHECK(blocked.truth.size() == flowing.truth.size());
    CHECK(blocked.stream.report().largest_lateness > 119s);
    CHECK(flowing.stream.report().largest_lateness < 1s);
}

TEST_CASE("frames decode to the truth, COUNT steps evenly", "[sim][device_stream]") {
    Rig rig;
    rig.bench.start_logging();
    rig.stream.advance_to(rig.scenario.start() + 10s);
    rig.drain(rig.scenario.start() + 10s);
    const auto frames = decode(rig.received);
    REQUIRE(frames.size() == rig.truth.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        CHECK(frames[i] == rig.truth[i].values);
        CHECK(frames[i].count == 80 * (i + 1));
        CHECK(rig.truth[i].grid_index == i + 7);
        CHECK(rig.truth[i].utc == rig.scenario.start() + static_cast<std::int64_t>(i + 7) * 20ms);
    }
}

TEST_CASE("the grid goes on while sampling is stopped", "[sim][device_stream]") {
    Rig rig, undisturbed;
    undisturbed.bench.start_logging();
    rig.bench.start_logging();
    const UtcTime start = rig.scenario.start();
    rig.stream.advance_to(start + 10s);
    rig.drain(start + 10s);
    rig.stream.receive(bytes_of("FE 00 0D 83 02 0D"), rig.bench.now);
    rig.stream.advance_to(start + 20s);
    rig.stream.receive(bytes_of("83 01 0D"), rig.bench.now);
    rig.stream.advance_to(start + 30s);
    rig.drain(start + 30s);
    for (UtcTime now = start; now <= start + 30s; now += 1s) {
        undisturbed.stream.advance_to(now);
        undisturbed.drain(now);
    }

    const auto& runs = rig.stream.report().runs;
    REQUIRE(runs.size() == 2);
    CHECK(runs[0].first_index == 7);
    // Samples after the command: index 1001 is the first, seven fill the filter.
    CHECK(runs[1].first_index == 1008);
    CHECK(runs[0].frames + runs[1].frames == rig.stream.report().frames_sent);
    const TruthRecord& restarted = rig.truth[static_cast<std::size_t>(runs[0].frames)];
    CHECK(restarted.values.count == 80);
    CHECK(restarted.sampling_run == 2);
    CHECK(restarted.values.axes == undisturbed.truth[1008 - 7].values.axes);
}

TEST_CASE("rates above the grid's hold each sample", "[sim][device_stream]") {
    Rig rig;
    rig.bench.send({"FE 01", "85 04", "86 08", "88 01", "8C 03", "8D C7", "FE 00", "83 01"});
    rig.stream.advance_to(rig.scenario.start() + 2s);
    rig.drain(rig.scenario.start() + 2s);
    REQUIRE(rig.truth.size() > 300);
    for (std::size_t i = 1; i < rig.truth.size(); ++i) {
        REQUIRE(rig.truth[i].utc - rig.truth[i - 1].utc == 5ms);
        REQUIRE(rig.truth[i].values.count == 20 * (i + 1));
        REQUIRE(rig.truth[i].grid_index == (i + 31) / 4);
    }
}

TEST_CASE("a truth file gives back its records and refuses what is none", "[sim][truth_file]") {
    const auto file = std::filesystem::temp_directory_path() / "a351_truth_test.bin";
    TruthRecord record;
    record.utc = *parse_rfc3339("2017-07-16T00:00:00.020Z");
    record.values.axes = {-1, 2, -2147483647};
    record.values.temperature = -1981;
    record.values.count = 65520;
    record.sampling_run = 3;
    record.grid_index = 4'000'000'000U;
    TruthWriter writer(file);
    writer.append(record);
    writer.append({});
    writer.close();
    CHECK(std::filesystem::file_size(file) == 16 + 2 * 32);
    const auto records = read_truth(file);
    REQUIRE(records.size() == 2);
    CHECK(records[0].utc == record.utc);
    CHECK(records[0].values == record.values);
    CHECK(records[0].sampling_run == 3);
    CHECK(records[0].grid_index == 4'000'000'000U);
    std::filesystem::resize_file(file, 50);
    CHECK_THROWS(read_truth(file));
    std::filesystem::remove(file);
}
