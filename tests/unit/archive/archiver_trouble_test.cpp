#include "tests/support/catch.hpp"

#include "protocol/archive/archiver.hpp"
#include "protocol/core/input_error.hpp"
#include "tests/unit/archive/collector.hpp"

using namespace a351;
using namespace a351::archive;
using namespace a351::journal;
using namespace std::chrono_literals;

namespace {

/// Returns the 2000 samples of z without first ... end - 1.
auto expected_without(std::int64_t first, std::int64_t end) {
    auto counts = expected(2, 0, first);
    const auto rest = expected(2, end, 2'000);
    counts.insert(counts.end(), rest.begin(), rest.end());
    return counts;
}

}  // namespace

TEST_CASE("a lost frame leaves exactly one gap of exactly one sample") {
    for (std::size_t bad_byte = 0; bad_byte < 24; ++bad_byte) {
        JournalStream stream;
        for (std::int64_t k = 0; k < 2'000; ++k) {
            auto frame = frame_of(values_of(k));
            if (k == 777) frame[bad_byte] ^= std::byte{0x44};
            stream.bytes(frame, due(k));
            if (k % 50 == 49) stream.second(due(k));
        }
        stream.flush();
        const auto run = archived(stream.chunks);
        INFO("byte " << bad_byte);
        CHECK(run.sink.counts("BNZ") == expected_without(777, 778));
        CHECK(run.counters.gaps == 1);
        CHECK(run.counters.samples_missing == 1);
        CHECK(run.counters.frames == 1'999);
        CHECK(run.counters.bytes_skipped == 24);
        std::int64_t index = 0;
        int flagged = 0;
        for (const auto& record : run.sink.decoded.at("BNZ")) {
            if (index == 777) ++index;
            const auto error = record.header.start -
                               (run.sink.decoded.at("BNZ").front().header.start + index * 20ms);
            CHECK(std::chrono::abs(error) <= Nanoseconds(1us));
            index += static_cast<std::int64_t>(record.samples.size());
            if (record.header.had_transmission_errors) ++flagged;
            CHECK(record.header.had_transmission_errors == (index == 777));
        }
        CHECK(flagged == 1);
        CHECK(index == 2'000);
    }
}

TEST_CASE("without a counter the number of lost samples is found from the skipped bytes") {
    const auto layout = *wire::BurstLayout::from_burst_ctrl(0x0101);  // z, CHKSM
    JournalStream stream;
    auto header = header_at(0s);
    header.burst_ctrl = layout.burst_ctrl();
    stream.chunks.front() = header;
    for (std::int64_t k = 0; k < 2'000; ++k) {
        std::vector<std::byte> frame;
        wire::append_frame(layout, values_of(k), frame);
        if (k >= 777 && k < 780) frame[2] ^= std::byte{0x44};
        stream.bytes(frame, due(k));
        if (k % 50 == 49) stream.second(due(k));
    }
    stream.flush();
    const auto run = archived(stream.chunks);
    CHECK(run.sink.counts("BNZ") == expected_without(777, 780));
    CHECK(run.counters.gaps == 1);
    CHECK(run.counters.samples_missing == 3);
    const auto& records = run.sink.decoded.at("BNZ");
    const auto& last = records.back();
    const auto index = 2'000 - static_cast<std::int64_t>(last.samples.size());
    CHECK(std::chrono::abs(last.header.start - (records.front().header.start + index * 20ms)) <=
          Nanoseconds(1us));
}

TEST_CASE("every byte is part of a frame, counted as skipped, or still pending") {
    std::mt19937_64 random(11);
    for (int round = 0; round < 20; ++round) {
        JournalStream stream;
        for (std::int64_t k = 0; k < 1'000; ++k) {
            auto frame = frame_of(values_of(k));
            const auto fate = random() % 40;
            if (fate == 0) frame.resize(random() % 24);
            if (fate == 1) frame[random() % 24] ^= std::byte(1U << random() % 8);
            if (fate == 2) frame.insert(frame.end(), 30, std::byte{0x80});
            if (!frame.empty()) stream.bytes(frame, due(k));
            if (k % 50 == 49) stream.second(due(k));
        }
        stream.flush();
        const auto run = archived(stream.chunks);
        const auto covered = run.counters.frames * 24 + run.counters.bytes_skipped;
        CHECK(covered <= run.counters.bytes);
        CHECK(run.counters.bytes - covered < 96);
        CHECK(run.counters.anomalies + run.counters.duplicates == 0);
        CHECK(run.sink.samples.size() + run.counters.samples_missing ==
              static_cast<std::size_t>(run.sink.samples.back().index -
                                       run.sink.samples.front().index + 1));
        for (const auto& sample : run.sink.samples) {
            const auto k =
                sample.index + (values_of(0).count == run.sink.samples.front().values.count
                                    ? 0
                                    : run.sink.samples.front().values.count / 80 - 1);
            REQUIRE(sample.values == values_of(k));
        }
    }
}

TEST_CASE("a device that restarts in mid-stream begins a new session") {
    JournalStream stream;
    stream.frames(0, 1'000);
    stream.frames(0, 1'000, due(1'000) + 30s);  // The counter starts again.
    const auto run = archived(stream.chunks);
    CHECK(run.counters.sessions == 2);
    CHECK(run.counters.gaps == 0);
    auto counts = expected(2, 0, 1'000);
    const auto again = expected(2, 0, 1'000);
    counts.insert(counts.end(), again.begin(), again.end());
    CHECK(run.sink.counts("BNZ") == counts);
    CHECK(run.sink.samples.back().index == 999);
}

TEST_CASE(
    "a header of the same session changes nothing, a header of another session ends the series") {
    JournalStream plain, rotated;
    plain.frames(0, 3'000);
    rotated.frames(0, 1'500);
    rotated.chunks.emplace_back(header_at(due(1'499)));
    rotated.frames(1'500, 3'000);
    CHECK(archived(plain.chunks).sink.packed == archived(rotated.chunks).sink.packed);

    JournalStream other;
    other.frames(0, 1'500);
    other.chunks.emplace_back(header_at(due(1'499), 2));
    other.frames(1'500, 3'000);
    const auto run = archived(other.chunks);
    CHECK(run.counters.sessions == 2);
    CHECK(run.sink.counts("BNZ") == expected(2, 0, 3'000));
    CHECK(run.sink.last.at("BNZ") == 1'499);
    int ends = 0, starts = 0;
    for (const auto& record : run.sink.decoded.at("BNZ")) {
        ends += record.header.ends_series ? 1 : 0;
        starts += record.header.starts_series ? 1 : 0;
    }
    CHECK(ends == 1);
    CHECK(starts == 2);
}

TEST_CASE("a duplicated frame is counted and dropped") {
    JournalStream stream;
    stream.frames(0, 100);
    stream.frame(99);
    stream.frames(100, 200);
    const auto run = archived(stream.chunks);
    CHECK(run.counters.duplicates == 1);
    CHECK(run.sink.counts("BNZ") == expected(2, 0, 200));
}

TEST_CASE("frames flagged for a forbidden pair of rate and filter count as missing samples") {
    JournalStream stream;
    stream.frames(0, 1'000, 0s, [](std::int64_t k, auto& values) {
        if (k < 300 || k >= 310) return;
        values.flag |= wire::kFlagAliasing;
        values.axes = {0x64000000, 0x64000000, 0x64000000};
    });
    const auto run = archived(stream.chunks);
    CHECK(run.counters.error_flags == 10);
    CHECK(run.counters.gaps == 1);
    CHECK(run.counters.samples_missing == 10);
    CHECK(run.sink.samples.size() == 990);
}

TEST_CASE("a journal of an unknown device profile or without a baud rate is refused") {
    Collector sink;
    Archiver archiver(sink);
    auto header = header_at(0s);
    header.profile = "A999";
    CHECK_THROWS_AS(archiver.take(header), InputError);
    header = header_at(0s);
    header.baud = 0;
    CHECK_THROWS_AS(archiver.take(header), InputError);
}
