#include "protocol/archive/archiver.hpp"

#include <algorithm>
#include <utility>
#include "tests/support/catch.hpp"

#include "protocol/archive/channel_code.hpp"
#include "tests/unit/archive/collector.hpp"

using namespace a351;
using namespace a351::archive;
using namespace a351::journal;
using namespace std::chrono_literals;

namespace {

/// Returns the same reads with the same time stamps, divided into chunks at other places.
std::vector<journal::Chunk> recut(const std::vector<journal::Chunk>& chunks, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<journal::Chunk> cut;
    for (const auto& chunk : chunks) {
        const auto* rx = std::get_if<RxChunk>(&chunk);
        if (!rx) {
            cut.push_back(chunk);
            continue;
        }
        std::size_t read = 0;
        while (read < rx->reads.size()) {  // a chunk has whole reads only
            const std::size_t from = read == 0 ? 0 : rx->reads[read - 1].end;
            const std::size_t reads =
                std::min<std::size_t>(1 + random() % 20, rx->reads.size() - read);
            RxChunk part;
            for (std::size_t i = 0; i < reads; ++i, ++read) {
                part.reads.push_back(
                    {static_cast<std::uint32_t>(rx->reads[read].end - from), rx->reads[read].time});
            }
            const auto begin = rx->bytes.begin() + static_cast<std::ptrdiff_t>(from);
            part.bytes.assign(begin, begin + part.reads.back().end);
            cut.emplace_back(std::move(part));
        }
    }
    return cut;
}

}  // namespace

TEST_CASE("the records contain every sample of a stream exactly once, bit for bit") {
    JournalStream stream;
    stream.frames(0, 20'000);
    const auto run = archived(stream.chunks);
    CHECK(run.sink.counts("BN1") == expected(0, 0, 20'000));
    CHECK(run.sink.counts("BN2") == expected(1, 0, 20'000));
    CHECK(run.sink.counts("BNZ") == expected(2, 0, 20'000));
    std::vector<std::int32_t> temperature;
    for (std::int64_t k = 0; k < 20'000; ++k) temperature.push_back(values_of(k).temperature);
    CHECK(run.sink.counts("BK1") == temperature);
    REQUIRE(run.sink.samples.size() == 20'000);
    for (std::int64_t k = 0; k < 20'000; ++k) {
        REQUIRE(run.sink.samples[static_cast<std::size_t>(k)].index == k);
        REQUIRE(run.sink.samples[static_cast<std::size_t>(k)].values == values_of(k));
    }
    CHECK(run.sink.last.at("BNZ") == 19'999);
    CHECK(run.counters.frames == 20'000);
    CHECK(run.counters.bytes == 20'000 * 24);
    CHECK(run.counters.sessions == 1);
    CHECK(run.counters.gaps + run.counters.anomalies + run.counters.bytes_skipped == 0);
}

TEST_CASE("records carry the times of their samples and the station codes of the journal header") {
    JournalStream stream;
    std::get<journal::Header>(stream.chunks.front()).declared_rate_hz = 50.0006;
    stream.frames(0, 5'000);
    const auto run = archived(stream.chunks);
    // k512_fc9: 511 / 2 / 4000 Hz = 63.875 ms; data ready after 430 us; 24 bytes at 460 800
    // baud = 520.833 us.
    const Nanoseconds delay = 63'875us + 430us + Nanoseconds(520'833);
    std::int64_t index = 0;
    for (const auto& record : run.sink.decoded.at("BNZ")) {
        const Nanoseconds error = record.header.start - (kStart + due(index) - delay);
        CHECK(std::chrono::abs(error) <= Nanoseconds(1us));
        CHECK(record.header.network == "XX");
        CHECK(record.header.station == "A351");
        CHECK(record.header.location == "00");
        CHECK(record.header.starts_series == (index == 0));
        CHECK_FALSE(record.header.ends_series);
        CHECK_FALSE(record.header.is_clipped);
        CHECK_FALSE(record.header.had_transmission_errors);
        CHECK(record.header.declared_rate_hz == double(50.0006F));
        index += static_cast<std::int64_t>(record.samples.size());
    }
}

TEST_CASE("the records do not depend on where the journal divides the stream into chunks") {
    JournalStream stream;
    std::mt19937_64 random(7);
    for (std::int64_t k = 0; k < 3'000; ++k) {
        auto frame = frame_of(values_of(k));
        if (k % 211 == 100) frame[random() % frame.size()] ^= std::byte{0x10};
        const auto middle = frame.begin() + static_cast<std::ptrdiff_t>(1 + random() % 23);
        stream.bytes({frame.begin(), middle}, due(k) - 1ms);
        stream.bytes({middle, frame.end()}, due(k));
        if (k % 50 == 49) stream.second(due(k));
    }
    const auto whole = archived(stream.chunks);
    CHECK(whole.counters.checksum_errors + whole.counters.framing_errors > 0);
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const auto cut = archived(recut(stream.chunks, seed));
        CHECK(cut.sink.packed == whole.sink.packed);
        CHECK(cut.counters.frames == whole.counters.frames);
    }
}

TEST_CASE("frames delivered by one read are time-stamped by their position in it") {
    JournalStream apart, together;
    for (std::int64_t k = 0; k < 3'000; k += 2) {
        const auto first = frame_of(values_of(k)), second = frame_of(values_of(k + 1));
        auto both = first;
        both.insert(both.end(), second.begin(), second.end());
        together.bytes(both, due(k + 1));
        apart.bytes(first, due(k + 1) - 520'833ns);  // 24 bytes at 460 800 baud
        apart.bytes(second, due(k + 1));
        if (k % 50 != 48) continue;
        together.second(due(k + 1));
        apart.second(due(k + 1));
    }
    together.flush();
    apart.flush();
    CHECK(archived(together.chunks).sink.packed == archived(apart.chunks).sink.packed);
}

TEST_CASE("records later than any that can be read are withheld") {
    const auto years = 365 * 24h * 150;
    JournalStream stream(1, years);
    stream.frames(0, 5'000, years);
    const auto run = archived(stream.chunks);
    CHECK(run.sink.packed.empty());
    CHECK(run.counters.records_withheld > 0);
    CHECK(run.sink.samples.size() == 5000);
}

TEST_CASE("by the times of its header no record reaches over UTC midnight") {
    // The sensor is 100 ppm fast, so header and sample clock differ by up to 1 ms in a record.
    const auto midnight = *parse_rfc3339("2026-03-02T00:00:00Z");
    int checked = 0;
    for (int offset_ms = 0; offset_ms < 20; ++offset_ms) {
        const auto before = 12h - 100s + std::chrono::milliseconds(offset_ms);
        JournalStream stream(1, before);
        for (std::int64_t k = 0; k < 6'000; ++k) {
            const auto at = before + due(k) - due(k) / 10'000;
            stream.bytes(frame_of(values_of(k)), at);
            if (k % 50 == 49) stream.second(at);
        }
        stream.flush();
        const auto run = archived(stream.chunks);
        CHECK(run.sink.counts("BNZ") == expected(2, 0, 6'000));
        for (const auto& [channel, records] : run.sink.decoded) {
            CAPTURE(channel);
            const auto first_after = std::ranges::find_if(
                records, [&](const auto& record) { return record.header.start >= midnight; });
            REQUIRE(first_after != records.begin());
            REQUIRE(first_after != records.end());
            CHECK(first_after->header.start - midnight < Nanoseconds(20ms));
            for (auto record = records.begin(); record != first_after; ++record, ++checked) {
                const auto count = static_cast<double>(record->samples.size() - 1);
                CHECK(record->header.start + from_seconds(count / record->rate_hz()) < midnight);
            }
            CHECK(std::all_of(first_after, records.end(),
                              [&](const auto& record) { return record.header.start >= midnight; }));
        }
    }
    CHECK(checked > 100);
}

TEST_CASE("records end at the age that the header states, with the same samples and times") {
    JournalStream stream;
    std::mt19937_64 random(8);
    for (std::int64_t k = 0; k < 20'000; ++k) {  // behind a timer of 16 ms
        const auto late = Nanoseconds(static_cast<std::int64_t>(random() % 16'000'000));
        stream.bytes(frame_of(values_of(k)), due(k) + late);
        if (k % 50 == 49) stream.second(due(k) + 17ms);
    }
    stream.flush();
    const auto usual = archived(stream.chunks);
    const auto age = GENERATE(1s, 2s, 5s);
    Collector sink;
    Archiver archiver(sink);
    std::map<std::string, std::size_t> seen;
    for (const auto& chunk : with_record_age(stream.chunks, age)) {
        archiver.take(chunk);
        const auto newest = archiver.last_index();
        if (!newest || *newest < 100) continue;  // times are fixed after 2 s
        for (const char* channel : {"BN1", "BN2", "BNZ", "BK1"})
            REQUIRE(*newest - sink.last[channel] <= 50 * age.count() + 1);
    }
    archiver.close_records();
    for (const auto& [channel, records] : sink.decoded) {
        CAPTURE(channel);
        if (channel == "LCE") continue;  // it refers to the records
        CHECK(sink.counts(channel) == usual.sink.counts(channel));
        if (!channel.starts_with("B")) continue;
        // The first record waits until the times of its samples are fixed.
        CHECK(std::ssize(records.front().samples) ==
              50 * std::max<std::int64_t>(age.count(), 2) + 1);
        CHECK(records[1].samples.size() == 50U * static_cast<unsigned>(age.count()) + 1);
        std::int64_t index = 0;
        for (const auto& record : records) {
            const auto time = archiver.clock()->time_of(index)->utc;
            CHECK(record.header.start == std::chrono::floor<std::chrono::microseconds>(time));
            index += static_cast<std::int64_t>(record.samples.size());
        }
    }
    CHECK(sink.packed.size() > usual.sink.packed.size());
}

TEST_CASE("the last samples before a silence are written to a record within its age") {
    const auto age = GENERATE(60s, 1s);
    JournalStream stream;
    stream.frames(0, 320);
    Collector sink;
    Archiver archiver(sink);
    for (const auto& chunk : with_record_age(stream.chunks, age)) archiver.take(chunk);
    archiver.take(clock_at(due(319) + age));
    CHECK(sink.counts("BNZ").size() < 320);
    archiver.take(clock_at(due(319) + age + 1ms));
    CHECK(sink.counts("BNZ") == expected(2, 0, 320));
}

TEST_CASE("samples that Steim-2 cannot hold are archived as plain integers") {
    JournalStream stream;
    stream.frames(0, 2'000, 0s, [](std::int64_t k, auto& values) {
        if (k == 500) values.axes[2] = -2'147'483'647;
        if (k == 501) values.axes[2] = 2'147'483'647;
    });
    const auto run = archived(stream.chunks);
    auto counts = expected(2, 0, 2'000);
    counts[500] = -2'147'483'647;
    counts[501] = 2'147'483'647;
    CHECK(run.sink.counts("BNZ") == counts);
    CHECK(run.counters.integer_records > 0);
    CHECK(run.counters.gaps == 0);
    int clipped = 0;
    for (const auto& record : run.sink.decoded.at("BNZ"))
        clipped += record.header.is_clipped ? 1 : 0;
    CHECK(clipped >= 1);
    for (const auto& record : run.sink.decoded.at("BN1")) CHECK_FALSE(record.header.is_clipped);
}

TEST_CASE("an alarm flag marks the records of its axis as clipped") {
    JournalStream stream;
    stream.frames(0, 3'000, 0s, [](std::int64_t k, auto& values) {
        if (k == 1'000) values.flag |= 0x0008;  // YALARM_ERR
    });
    const auto run = archived(stream.chunks);
    CHECK(run.counters.error_flags == 1);
    std::int64_t index = 0;
    for (const auto& record : run.sink.decoded.at("BN2")) {
        const auto end = index + static_cast<std::int64_t>(record.samples.size());
        CHECK(record.header.is_clipped == (index <= 1'000 && 1'000 < end));
        index = end;
    }
    for (const auto& record : run.sink.decoded.at("BNZ")) CHECK_FALSE(record.header.is_clipped);
}

TEST_CASE("the band code follows from the rate, the channels from the frame layout") {
    for (const auto& [rate_hz, band] :
         {std::pair(50, 'B'), std::pair(100, 'H'), std::pair(500, 'C'), std::pair(1000, 'F')}) {
        const auto layout = *wire::BurstLayout::from_burst_ctrl(0x0103);  // z, COUNT, CHKSM
        auto header = header_at(0s);
        header.output_rate_hz = rate_hz;
        header.burst_ctrl = layout.burst_ctrl();
        JournalStream stream;
        stream.chunks.front() = header;
        for (std::int64_t k = 0; k < 500; ++k) {
            auto values = values_of(k);
            values.count = static_cast<std::uint16_t>(4000 / rate_hz * (k + 1));
            std::vector<std::byte> bytes;
            wire::append_frame(layout, values, bytes);
            stream.bytes(bytes, Nanoseconds(1s) / rate_hz * (k + 1));
        }
        stream.flush();
        const auto run = archived(stream.chunks);
        std::string channels;
        for (const auto& [channel, records] : run.sink.decoded)
            if (!is_derived(channel)) channels += channel;
        CHECK(channels == std::string(1, band) + "NZ");
        CHECK(run.sink.decoded.count("LK1") == 0);
        CHECK(run.sink.counts(std::string(1, band) + "NZ") == expected(2, 0, 500));
    }
}
