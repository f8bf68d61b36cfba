#include "protocol/archive/slow_channels.hpp"

#include <random>
#include <set>
#include "tests/support/catch.hpp"

#include "tests/unit/archive/collector.hpp"

using namespace a351;
using namespace a351::archive;
using namespace a351::journal;
using namespace std::chrono_literals;

namespace {

using Seconds = std::vector<std::pair<UtcTime, std::int32_t>>;

/// Returns the samples of a slow channel with their times, in the order of its records.
Seconds seconds_of(const Collector& sink, const std::string& channel, Nanoseconds interval = 1s) {
    Seconds seconds;
    const auto found = sink.decoded.find(channel);
    if (found == sink.decoded.end()) return seconds;
    for (const auto& record : found->second) {
        REQUIRE(record.rate_hz() == 1.0 / std::chrono::duration<double>(interval).count());
        REQUIRE_FALSE(record.header.declared_rate_hz);
        REQUIRE(record.header.start ==
                std::chrono::floor<std::chrono::seconds>(record.header.start));
        REQUIRE(record.samples.size() <= 61);
        UtcTime time = record.header.start;
        for (const auto counts : record.samples) {
            seconds.emplace_back(time, counts);
            time += interval;
        }
    }
    return seconds;
}

/// Delay from a sample to the last byte of its frame: filter k512_fc9, data ready, 24 bytes at
/// 460 800 baud (see archiver_test.cpp).
constexpr Nanoseconds kDelay = 63'875us + 430us + Nanoseconds(520'833);

/// First sample of the first whole second after kStart. Second n has the samples 3 + 50 n ... 52 +
/// 50 n, because sample k is at 20 ms (k + 1) - kDelay.
constexpr std::int64_t kFirst = 3;

std::int32_t mean_temperature(std::int64_t first, std::int64_t end) {
    double sum = 0.0;
    for (std::int64_t k = first; k < end; ++k) sum += values_of(k).temperature;
    // M-A352AD10 data sheet 7.6.
    return static_cast<std::int32_t>(
        std::llround(1000.0 * (34.987 - 0.0037918 * sum / static_cast<double>(end - first))));
}

/// Returns the stream of a device whose seconds last `second` on the host.
JournalStream stream_of(std::int64_t count, Nanoseconds second, std::optional<double> rate_hz) {
    JournalStream stream;
    std::get<journal::Header>(stream.chunks.front()).declared_rate_hz = rate_hz;
    for (std::int64_t k = 0; k < count; ++k) {
        stream.bytes(frame_of(values_of(k)), (k + 1) * second / 50);
        if (k % 50 == 49) stream.second((k + 1) * second / 50);
    }
    stream.flush();
    return stream;
}

/// Returns a stream whose clock readings are changed from sample 5 000 on.
JournalStream stream_with_clock(std::int64_t count, auto change) {
    JournalStream stream;
    stream.frames(0, count);
    for (journal::Chunk& chunk : stream.chunks) {
        auto* reading = std::get_if<timing::ClockReading>(&chunk);
        if (reading != nullptr && reading->raw > kRawStart + due(5'000)) change(*reading);
    }
    return stream;
}

}  // namespace

TEST_CASE("every complete second gets the mean temperature of its samples") {
    JournalStream stream;
    std::get<journal::Header>(stream.chunks.front()).declared_rate_hz = 50.0006;
    stream.frames(0, 10'000);
    const auto run = archived(stream.chunks);
    const auto means = seconds_of(run.sink, "LK1");
    REQUIRE(means.size() == 199);  // the last second is not over
    for (std::size_t n = 0; n < means.size(); ++n) {
        const auto first = kFirst + 50 * static_cast<std::int64_t>(n);
        REQUIRE(means[n].first == kStart + n * 1s);
        REQUIRE(means[n].second == mean_temperature(first, first + 50));
    }
    CHECK(run.sink.last.at("LK1") == kFirst + 199 * 50 - 1);
    CHECK(run.sink.decoded.at("LK1").front().header.starts_series);
    CHECK(seconds_of(run.sink, "LCQ").size() == 199);
}

TEST_CASE("a second without samples is a gap, a second with some samples gets their mean") {
    JournalStream stream;
    stream.frames(0, 1'000);
    stream.frames(1'110, 3'000);
    const auto run = archived(stream.chunks);
    // Second 19 has the samples 953 ... 999, second 22 has 1 110 ... 1 152.
    const auto means = seconds_of(run.sink, "LK1");
    std::set<std::int64_t> missing;
    for (std::int64_t n = 0; n < 59; ++n) missing.insert(n);
    for (const auto& [time, mean] : means) {
        const auto n = (time - kStart) / 1s;
        missing.erase(n);
        if (n == 22) CHECK(mean == mean_temperature(1'110, 1'153));
    }
    CHECK(missing == std::set<std::int64_t>{20, 21});
}

TEST_CASE("the values of the slow channels do not depend on where their records end") {
    JournalStream stream;
    for (std::int64_t k = 0; k < 9'000; ++k) {
        stream.frame(k);
        if (k % 50 == 49) stream.second(due(k));
        if (k % 70 == 13) stream.oven(due(k), static_cast<std::uint16_t>(400 + k % 50));
    }
    stream.flush();
    const auto whole = archived(stream.chunks);
    std::mt19937_64 random(3);
    Collector sink;
    Archiver archiver(sink);
    for (const auto& chunk : stream.chunks) {
        archiver.take(chunk);
        if (random() % 30 == 0) archiver.close_records();
    }
    archiver.close_records();
    for (const char* channel : {"LK1", "LCQ", "LK2", "LK3", "LYH"}) {
        INFO(channel);
        CHECK(seconds_of(sink, channel) == seconds_of(whole.sink, channel));
        CHECK(sink.decoded.at(channel).size() > whole.sink.decoded.at(channel).size());
    }
}

TEST_CASE(
    "the clock error of each second is the error of its time reckoned from record start and header "
    "rate") {
    // 20 ppm fast: a second of 50 samples lasts 20 us less.
    const bool is_declared = GENERATE(false, true);
    const auto rate_hz = is_declared ? std::optional(50.001) : std::nullopt;
    const auto run = archived(stream_of(30'000, 1s - 20us, rate_hz).chunks);
    const auto& records = run.sink.decoded.at("BN1");
    const double per_second_us = is_declared ? 0.0 : -20.0;
    std::size_t record = 0, seen = 0;
    for (const auto& [time, error_us] : seconds_of(run.sink, "LCE")) {
        while (record + 1 < records.size() && records[record + 1].header.start <= time) ++record;
        REQUIRE(records[record].header.start <= time);
        ++seen;
        if (time < kStart + 200s) continue;  // the rate is not known yet
        // Rates are known to 1 ppm by then, and the float in blockette 100 is exact to 0.04 ppm. A
        // record lasts up to 14 s, a sample 20 ms; stamps have steps of 1 us.
        const double since_s = seconds_between(records[record].header.start, time);
        REQUIRE(error_us == Approx(per_second_us * since_s).margin(2.0 + since_s));
    }
    CHECK(seen >= 597);
}

TEST_CASE("the clock quality of a second is that of its samples") {
    const auto stream =
        stream_with_clock(10'000, [](auto& reading) { reading.max_error_us = 100'000; });
    const auto run = archived(stream.chunks);
    const auto qualities = seconds_of(run.sink, "LCQ");
    REQUIRE(qualities.size() == 199);
    // The host states errors of up to 0.5 ms and 100 ms. The line itself is known to 3 ms or
    // better, because a timer in step with the sensor may hide as much.
    CHECK(qualities[90].second >= 89);
    CHECK(qualities[150].second == 60);
}

TEST_CASE("seconds in which the clock is set are missing, all others occur once") {
    const Nanoseconds step = GENERATE(Nanoseconds(3'300ms), Nanoseconds(-7'700ms));
    const auto stream = stream_with_clock(12'000, [&](auto& reading) { reading.realtime += step; });
    const auto run = archived(stream.chunks);
    const auto means = seconds_of(run.sink, "LK1");
    std::vector<Nanoseconds> jumps;
    for (std::size_t i = 1; i < means.size(); ++i) {
        const Nanoseconds by = means[i].first - means[i - 1].first;
        if (by != 1s) jumps.push_back(by);
    }
    REQUIRE(jumps.size() == 1);
    // One second ends in the step, one begins in it.
    CHECK(std::chrono::abs(jumps.front() - 1s - step) <= 2s);
    CHECK(jumps.front() >= step + 1s);
    // Each value is a mean of 50 samples in a row: temperature rises by one count in two seconds.
    for (std::size_t i = 1; i < means.size(); ++i)
        REQUIRE(std::abs(means[i].second - means[i - 1].second) <= 8);
}

TEST_CASE("each value of the oven is stored at the nearest second") {
    JournalStream stream;
    for (std::int64_t k = 0; k < 3'000; ++k) {
        stream.frame(k);
        if (k % 50 == 49) stream.second(due(k));
        // 0.3 s before each second of the sensor's time
        if (k % 50 != 37) continue;
        const auto n = k / 50 + 1;
        const Nanoseconds at = n * 1s - 300ms;
        if (n == 20) {
            stream.flush();
            stream.chunks.emplace_back(OvenChunk{kRawStart + at, OvenOutcome::timed_out, 1, {}});
            continue;
        }
        stream.oven(at, static_cast<std::uint16_t>(400 + n), n == 30 ? 0x0140 : 0x0100);
        if (n == 40) stream.oven(at + 100ms, 777);  // once more within the second
    }
    stream.flush();
    const auto run = archived(stream.chunks);
    Seconds process, set_point, heating;
    for (int n = 1; n <= 60; ++n) {
        const UtcTime second = kStart + n * 1s;
        if (n == 20) continue;                                        // no answer
        if (n != 30) process.emplace_back(second, 40'000 + 100 * n);  // else input error
        set_point.emplace_back(second, 42'500);
        heating.emplace_back(second, 6'170);
    }
    CHECK(seconds_of(run.sink, "LK2") == process);
    CHECK(seconds_of(run.sink, "LK3") == set_point);
    CHECK(seconds_of(run.sink, "LYH") == heating);
}

TEST_CASE("the outer oven has channels and an interval of its own") {
    JournalStream stream;
    std::get<journal::Header>(stream.chunks.front()).outer_oven_interval = 5s;
    stream.frames(0, 500);
    for (int n = 11; n <= 60; ++n) {
        stream.oven(n * 1s, 425);
        if (n % 5 == 0) {
            stream.oven(n * 1s + 100ms, static_cast<std::uint16_t>(380 + n));
            std::get<OvenChunk>(stream.chunks.back()).place = journal::OvenPlace::outer;
        }
        stream.second(n * 1s + 200ms);
    }
    const auto run = archived(stream.chunks);
    Seconds process;
    for (int n = 15; n <= 60; n += 5) process.emplace_back(kStart + n * 1s, 38'000 + 100 * n);
    CHECK(seconds_of(run.sink, "LK4", 5s) == process);
    CHECK(seconds_of(run.sink, "LK5", 5s).size() == process.size());
    CHECK(seconds_of(run.sink, "LYO", 5s).size() == process.size());
    const auto inner = seconds_of(run.sink, "LK2");
    REQUIRE(inner.size() == 50);
    for (const auto& [second, counts] : inner) REQUIRE(counts == 42'500);
}

TEST_CASE("the oven is archived while the sensor is silent") {
    JournalStream stream;
    stream.frames(0, 500);
    for (int n = 11; n <= 200; ++n) {
        stream.oven(n * 1s, 425);
        stream.second(n * 1s + 100ms);
    }
    Collector sink;
    Archiver archiver(sink);
    for (const auto& chunk : stream.chunks) archiver.take(chunk);
    const auto known = seconds_of(sink, "LK2");
    REQUIRE(known.size() >= 122);  // of 190 values, those that are older than 60 s
    CHECK(known.front().first == kStart + 11s);
    CHECK(known.back().first - known.front().first == (known.size() - 1) * 1s);
    CHECK(sink.decoded.at("LK2").size() <= 4);
    archiver.take(clock_at(400s));
    CHECK(seconds_of(sink, "LK2").size() == 190);
}

TEST_CASE("polls that fall halfway between two seconds are all stored") {
    // The polls are half a second off the grid, with a small jitter.
    const auto jitter = GENERATE(2ms, 8ms);
    constexpr int kPolls = 3'600;
    std::mt19937_64 random(7);
    std::uniform_int_distribution<std::int64_t> beside(-Nanoseconds(jitter).count(),
                                                       Nanoseconds(jitter).count());
    JournalStream stream;
    stream.frames(0, 500);
    for (int n = 0; n < kPolls; ++n) {
        const Nanoseconds at = 20s + n * 1s + 500ms;
        stream.oven(at + Nanoseconds(beside(random)), static_cast<std::uint16_t>(400 + n % 500));
        stream.second(at + 100ms);
    }
    const auto run = archived(stream.chunks);
    const auto process = seconds_of(run.sink, "LK2");
    REQUIRE(process.size() == kPolls);
    for (std::size_t n = 0; n < process.size(); ++n) {
        REQUIRE(process[n].first == process.front().first + n * 1s);
        REQUIRE(process[n].second == 40'000 + 100 * static_cast<std::int32_t>(n % 500));
    }
    CHECK(run.sink.decoded.at("LK2").size() <= kPolls / 60 + 2);
}

TEST_CASE(
    "no value of the oven is stored far from the time of its poll, and only failed polls leave a "
    "gap") {
    const auto [interval, every, most] =
        GENERATE(table<std::chrono::seconds, Nanoseconds, Nanoseconds>(
            {{1s, 100ms, 600ms}, {1s, 900ms, 600ms}, {1s, 1s, 600ms}, {2s, 1200ms, 1s}}));
    const auto phase = GENERATE(0ms, 300ms, 450ms, 700ms, 950ms);
    CAPTURE(every.count(), phase.count());
    constexpr int kPolls = 400, kFirstFailed = 150, kFailed = 40;
    JournalStream stream;
    std::get<journal::Header>(stream.chunks.front()).oven_interval = interval;
    stream.frames(0, 500);
    for (int n = 0; n < kPolls; ++n) {
        const Nanoseconds at = 20s + phase + n * every;
        if (n < kFirstFailed || n >= kFirstFailed + kFailed)
            stream.oven(at, static_cast<std::uint16_t>(400 + n));
        stream.second(at + 1ms);
    }
    const auto run = archived(stream.chunks);
    std::vector<Nanoseconds> pauses;
    UtcTime before{};
    for (const auto& [time, counts] : seconds_of(run.sink, "LK2", interval)) {
        const auto n = (counts - 40'000) / 100;
        REQUIRE(std::chrono::abs(time - (kStart + 20s + phase + n * every)) <= most);
        if (before != UtcTime{} && time != before + interval) pauses.push_back(time - before);
        before = time;
    }
    REQUIRE(pauses.size() == 1);
    CHECK(std::chrono::abs(pauses.front() - (kFailed + 1) * every) <= interval + most);
}

TEST_CASE("an oven that is polled seldom has a channel with the rate of its polls") {
    const auto [interval, wanders] = GENERATE(std::pair(2s, 400ms), std::pair(7s, 900ms),
                                              std::pair(60s, 0ms), std::pair(3600s, 900ms));
    constexpr int kPolls = 150, kMissing = 99;
    JournalStream stream;
    std::get<journal::Header>(stream.chunks.front()).oven_interval = interval;
    stream.frames(0, 500);
    Seconds expected;
    for (int n = 0; n < kPolls; ++n) {
        const Nanoseconds at = 20s + n * interval;
        if (n == kMissing) continue;
        stream.oven(at + (n % 2 == 0 ? Nanoseconds(0) : Nanoseconds(wanders)),
                    static_cast<std::uint16_t>(400 + n));
        stream.second(at + 950ms);
        expected.emplace_back(kStart + at, 40'000 + 100 * n);
    }
    const auto run = archived(stream.chunks);
    CHECK(seconds_of(run.sink, "LK2", interval) == expected);
    CHECK(seconds_of(run.sink, "LK3", interval).size() == expected.size());
    // A record has many values: it lasts up to an hour, and ends at midnight and at a missing
    // value.
    const auto span = kPolls * interval;
    const auto most = 2 + 2 + span / std::min<Nanoseconds>(60 * interval, 1h);
    CHECK(run.sink.decoded.at("LK2").size() <= static_cast<std::size_t>(most));
}

TEST_CASE("a channel of the oven continues after a pause and with another polling interval") {
    JournalStream stream;
    std::get<journal::Header>(stream.chunks.front()).oven_interval = 10s;
    stream.frames(0, 500);
    for (const auto at : {20s, 30s, 34s, 40s, 65s, 75s}) stream.oven(at, 400);
    stream.second(80s);
    auto header = header_at(81s);  // The daemon was started again, the sensor's stream continues.
    header.oven_interval = 2s;
    stream.chunks.emplace_back(header);
    for (const auto at : {83s, 85s}) stream.oven(at, 401);
    const auto run = archived(stream.chunks);
    std::vector<std::pair<Nanoseconds, std::size_t>> records;
    for (const auto& record : run.sink.decoded.at("LK2"))
        records.emplace_back(record.header.start - kStart, record.samples.size());
    // The value only 4 s after another one is left out.
    CHECK(records == decltype(records){{20s, 3}, {65s, 2}, {83s, 2}});
}

TEST_CASE("a sensor without temperature has only the slow channels of the clock") {
    const auto layout = *wire::BurstLayout::from_burst_ctrl(0x0103);  // z, COUNT, CHKSM
    JournalStream stream;
    std::get<journal::Header>(stream.chunks.front()).burst_ctrl = layout.burst_ctrl();
    for (std::int64_t k = 0; k < 1'000; ++k) {
        std::vector<std::byte> bytes;
        wire::append_frame(layout, values_of(k), bytes);
        stream.bytes(bytes, due(k));
    }
    stream.flush();
    const auto run = archived(stream.chunks);
    CHECK(run.sink.decoded.count("LK1") == 0);
    CHECK(seconds_of(run.sink, "LCQ").size() == 19);
    CHECK(seconds_of(run.sink, "LCE").size() >= 19);
}
