#include "sim/device/device_stream.hpp"

#include "tests/support/catch.hpp"

#include "protocol/wire/burst_decoder.hpp"
#include "sim/signal/signal_source.hpp"
#include "tests/unit/sim/device/machine_script.hpp"
#include "tests/unit/sim/truth_reader.hpp"

using namespace a351;
using namespace a351::sim;
using namespace a351::sim::device;
using namespace a351::sim::scenario;
using namespace a351::sim::signal;
using namespace a351::sim::truth;
using namespace std::chrono_literals;

namespace {

/// Everything the device sends; full at `most` bytes.
struct Collected final : LineSink {
    void send(std::span<const std::byte> sent, UtcTime leaves,
              const truth::Record* frame) override {
        bytes.insert(bytes.end(), sent.begin(), sent.end());
        if (frame == nullptr) return;
        truth.push_back(*frame);
        times.push_back(leaves);
    }
    [[nodiscard]] bool is_full() const override { return bytes.size() >= most; }

    std::size_t most = SIZE_MAX;
    std::vector<std::byte> bytes;
    std::vector<truth::Record> truth;
    std::vector<UtcTime> times;
};

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

/// A source of numbered samples: x of sample k is k.
class CountingSource final : public SampleSource {
public:
    explicit CountingSource(int rate_hz) : rate_hz_(rate_hz) {}
    [[nodiscard]] int rate_hz() const noexcept override { return rate_hz_; }
    [[nodiscard]] std::optional<UtcTime> next_instant() const override {
        return UtcTime(index * Nanoseconds(1s) / rate_hz_);
    }
    [[nodiscard]] TimedSample next() override {
        TimedSample sample{*next_instant(), index, {}};
        sample.values.axes_counts[0] = static_cast<std::int32_t>(index);
        ++index;
        return sample;
    }
    std::int64_t index = 0;

private:
    int rate_hz_;
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
    rig.advance_to(start + 140ms + delay - 1ns);
    CHECK(rig.line.bytes.empty());
    rig.advance_to(start + 140ms + delay);
    CHECK(rig.line.bytes.size() == 24);
    REQUIRE(rig.line.truth.size() == 1);
    CHECK(rig.line.truth[0].utc == start + 140ms);
    CHECK(rig.line.truth[0].grid_index == 7);
    CHECK(rig.line.times[0] == start + 140ms + delay);
}

TEST_CASE("a full line delays the device and does not change what it sends",
          "[sim][device_stream]") {
    Rig blocked, flowing;
    blocked.bench.start_logging();
    flowing.bench.start_logging();
    const UtcTime end = blocked.scenario.start() + 120s;
    for (UtcTime now = blocked.scenario.start(); now <= end; now += 1s) flowing.advance_to(now);
    for (blocked.line.most = 10; blocked.line.bytes.size() < flowing.line.bytes.size();
         blocked.line.most += 1000) {
        blocked.advance_to(end);
        REQUIRE(blocked.line.bytes.size() < blocked.line.most + 24);
    }
    CHECK(blocked.line.bytes == flowing.line.bytes);
    CHECK(blocked.line.times == flowing.line.times);
}

TEST_CASE("a device far behind catches up in pieces and answers commands between them",
          "[sim][device_stream]") {
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

TEST_CASE("frames decode to the truth, and COUNT advances evenly", "[sim][device_stream]") {
    Rig rig;
    rig.bench.start_logging();
    rig.advance_to(rig.scenario.start() + 10s);
    const auto& truth = rig.line.truth;
    const auto frames = decode(rig.line.bytes);
    REQUIRE(frames.size() == truth.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        CHECK(frames[i] == truth[i].values);
        CHECK(frames[i].count == 80 * (i + 1));
        CHECK(truth[i].grid_index == i + 7);
        CHECK(truth[i].utc == rig.scenario.start() + static_cast<std::int64_t>(i + 7) * 20ms);
    }
}

TEST_CASE("the sample grid continues while sampling is stopped", "[sim][device_stream]") {
    Rig rig, undisturbed;
    undisturbed.bench.start_logging();
    rig.bench.start_logging();
    const UtcTime start = rig.scenario.start();
    rig.advance_to(start + 10s);
    rig.receive("FE 00 0D 83 02 0D");
    const std::size_t first_run = rig.line.truth.size();
    rig.advance_to(start + 20s);
    CHECK(rig.line.truth.size() == first_run);
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

TEST_CASE("an answer is sent at once, between frames", "[sim][device_stream]") {
    Rig rig;
    rig.bench.start_logging();
    rig.advance_to(rig.scenario.start() + 1s);
    const std::size_t size = rig.line.bytes.size();
    rig.receive("02 00 0D");
    CHECK(rig.line.bytes.size() == size + 4);
    CHECK(hex_of(std::span(rig.line.bytes).last(4)) == "02 00 00 0D");
}

TEST_CASE("an output rate above the grid's repeats each sample", "[sim][device_stream]") {
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

TEST_CASE("after a stop between repeats of a sample a lower rate is on time from its first frame",
          "[sim][device_stream]") {
    // Stopped at 1000/s with 15 of 20 repeats sent, started again at 50/s before the next sample.
    CountingSource source(50);
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

TEST_CASE("a truth file gives its records back", "[sim][truth_file]") {
    const auto file = std::filesystem::temp_directory_path() / "a351_truth_test.bin";
    truth::Record record;
    record.utc = *parse_rfc3339("2017-07-16T00:00:00.020Z");
    record.values.axes = {-1, 2, -2147483647};
    record.values.temperature = -1981;
    record.values.count = 65520;
    record.sampling_run = 3;
    record.grid_index = 4'000'000'000U;
    record.fate = Fate::misplaced;
    truth::Writer writer(file);
    writer.append(record);
    writer.append({});
    writer.close();
    CHECK(std::filesystem::file_size(file) == 16 + 2 * 40);
    const auto records = read_truth(file);
    REQUIRE(records.size() == 2);
    CHECK(records[0].utc == record.utc);
    CHECK(records[0].values == record.values);
    CHECK(records[0].sampling_run == 3);
    CHECK(records[0].grid_index == 4'000'000'000U);
    CHECK(records[0].fate == Fate::misplaced);
    CHECK(records[1].fate == Fate::intact);
    std::filesystem::remove(file);
}
