#include <fstream>
#include <map>
#include "tests/support/catch.hpp"

#include "protocol/archive/archiver.hpp"
#include "protocol/journal/journal_reader.hpp"
#include "sim/replay/recording.hpp"
#include "tests/unit/sim/replay/replay_host.hpp"

namespace a351::sim::replay {
namespace {

const std::string kLogs = A351_GOLDEN "/logs/";

/// A row of the expected samples: index, count, x, y, z, temp.
using Row = std::array<std::int64_t, 6>;

class Samples final : public archive::Sink {
public:
    void record(const std::string&, const archive::PackedRecord&, std::int64_t) override {}
    void sample(const archive::Sample& sample) override {
        const auto& [flag, temperature, axes, count] = sample.values;
        rows.push_back({sample.index, count, axes[0], axes[1], axes[2], temperature});
    }
    std::vector<Row> rows;
};

std::vector<Row> expected_samples(const std::string& name) {
    std::ifstream in(kLogs + name + ".csv");
    std::string line;
    std::getline(in, line);
    REQUIRE(line == "index,count,x,y,z,temp");
    std::vector<Row> rows;
    for (Row row; in >> row[0];) {
        for (std::size_t i = 1; i < row.size(); ++i) in.ignore(1) >> row[i];
        rows.push_back(row);
    }
    return rows;
}

using Counters = std::map<std::string, std::uint64_t>;

Counters expected_counters(const std::string& name) {
    std::ifstream in(kLogs + name + ".counters");
    Counters counters;
    std::string key;
    for (std::uint64_t value = 0; in >> key >> value;) counters[key] = value;
    return counters;
}

Counters named(const archive::Counters& counters) {
    return {{"bytes", counters.bytes},
            {"frames", counters.frames},
            {"bytes_skipped", counters.bytes_skipped},
            {"checksum_errors", counters.checksum_errors},
            {"framing_errors", counters.framing_errors},
            {"gaps", counters.gaps},
            {"samples_missing", counters.samples_missing},
            {"duplicates", counters.duplicates},
            {"anomalies", counters.anomalies},
            {"sessions", counters.sessions}};
}

struct Outcome {
    std::vector<Row> samples;
    Counters counters;
};

/// Replays the log.  @return the samples and counters that a daemon gets from it
Outcome replayed(const std::string& name, Timing timing) {
    journal::Reader reader(kLogs + name + ".a351j");
    const auto header = std::get<journal::Header>(*reader.next());
    Device device(open_recording({.files = {kLogs + name + ".a351j"}}), timing, Nanoseconds(0));
    ReplayHost host(device, header.clock.realtime);
    const auto identity = host.configure();
    CHECK(identity.product_id == header.product_id);
    CHECK(identity.serial_number == header.serial_number);
    CHECK(identity.firmware == header.firmware);
    host.line.pieces.clear();
    host.listen();
    CHECK(device.recording().damage().empty());

    Samples sink;
    archive::Archiver archiver(sink);
    archiver.take(header);
    const Nanoseconds raw_minus_utc =
        header.clock.raw.time_since_epoch() - header.clock.realtime.time_since_epoch();
    for (const auto& piece : host.line.pieces) {
        journal::RxChunk chunk;
        chunk.bytes = piece.bytes;
        chunk.reads = {{static_cast<std::uint32_t>(piece.bytes.size()),
                        RawTime(piece.leaves.time_since_epoch() + raw_minus_utc)}};
        archiver.take(chunk);
    }
    archiver.close_records();
    return {sink.rows, named(archiver.counters())};
}

}  // namespace

TEST_CASE("every golden log replays to its expected samples and counters, at either speed") {
    const std::string name = GENERATE("clean_start", "flipped_bits", "lost_bytes_and_garbage",
                                      "gap_over_a_wrap", "duplicates", "markers_in_payload");
    const auto timing = GENERATE(Timing::as_recorded, Timing::as_fast_as_read);
    // Only arrival times show how often the counter wrapped.
    if (name == "gap_over_a_wrap" && timing == Timing::as_fast_as_read) return;
    CAPTURE(name, static_cast<int>(timing));
    const Outcome outcome = replayed(name, timing);
    CHECK(outcome.samples.size() >= 240);
    CHECK(outcome.samples == expected_samples(name));
    CHECK(outcome.counters == expected_counters(name));
}

}  // namespace a351::sim::replay
