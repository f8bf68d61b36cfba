#include "protocol/archive/retime.hpp"

#include <algorithm>
#include <cstdio>
#include <random>
#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"
#include "protocol/events/event_log.hpp"
#include "tests/support/file_bytes.hpp"
#include "tests/unit/archive/data_root.hpp"
#include "tests/unit/files/failing_files.hpp"

using namespace a351;
using namespace a351::archive;
using namespace a351::events;
using namespace a351::files;
using namespace a351::journal;
using namespace std::chrono_literals;

namespace {

/// Returns ten minutes with late frames and a gap. The host's clock is an hour slow until it is
/// synchronised at sample `synchronised`.
std::vector<journal::Chunk> badly_timed_session(std::int64_t synchronised) {
    const auto reading = [&](Nanoseconds now, std::int64_t k) {
        timing::ClockReading clock = clock_at(now);
        clock.boottime = clock.raw.time_since_epoch();
        clock.is_synchronised = k >= synchronised;
        if (!clock.is_synchronised) clock.realtime -= 1h;
        return clock;
    };
    JournalStream stream;
    std::get<journal::Header>(stream.chunks.front()).clock = reading(0s, 0);
    std::mt19937_64 random(5);
    for (std::int64_t k = 0; k < 30'000; ++k) {
        if (k >= 4'000 && k < 4'003) continue;
        stream.bytes(frame_of(values_of(k)),
                     due(k) + Nanoseconds(static_cast<std::int64_t>(random() % 900'000)));
        if (k % 50 != 49) continue;
        stream.flush();
        stream.chunks.emplace_back(reading(due(k) + 1ms, k));
    }
    stream.flush();
    return stream.chunks;
}

/// Returns the true time of sample k, whose frame is complete at due(k).
UtcTime truth(std::int64_t k) {
    return kStart + due(k) - (63'875us + 430us + Nanoseconds(520'833));
}

}  // namespace

TEST_CASE("a re-timed archive has the same samples, with the times that the whole journal gives") {
    DataRoot root;
    const auto chunks = badly_timed_session(15'000);
    root.write_journal(chunks);
    archive_all(root, chunks);
    Event event;
    event.type = "start";
    event.session = std::get<journal::Header>(chunks.front()).session;
    event.index = 500;
    event.utc = truth(500) - 1h;
    append_event(posix_files(), root.path() / "events", event);

    DataRoot parent;
    const auto out = parent.path() / "better";
    const RetimeReport report = retime(posix_files(), root.path(), out);
    CHECK(report.counters.gaps == 1);
    CHECK(report.damage.empty());
    CHECK(report.unsynchronised_runs == 0);

    const auto before = root.records("BNZ"), after = records_in(out / "archive", "BNZ");
    CHECK(samples_of(after) == samples_of(before));
    CHECK(std::chrono::abs(before.front().header.start - truth(0) + 1h) < Nanoseconds(2ms));
    std::int64_t k = 0;
    for (const DecodedRecord& record : after) {
        if (k == 4'000) k = 4'003;
        const Nanoseconds error = record.header.start - truth(k);
        REQUIRE(std::chrono::abs(error) < Nanoseconds(500us));
        REQUIRE_FALSE(record.header.is_time_questionable);
        k += static_cast<std::int64_t>(record.samples.size());
    }
    CHECK(k == 30'000);
    const auto events = read_events(out / "events").events;
    REQUIRE(events.size() == 1);
    CHECK(std::chrono::abs(events[0].utc - truth(500)) < Nanoseconds(500us));
    CHECK(events[0].index == 500);
}

TEST_CASE("re-timing writes a complete archive or nothing, and counts runs that nothing corrects") {
    DataRoot root, parent;
    const auto out = parent.path() / "better";
    CHECK_THROWS_AS(retime(posix_files(), root.path(), out), InputError);
    CHECK_FALSE(std::filesystem::exists(out));
    root.write_journal(badly_timed_session(30'000));  // It is never synchronised.
    CHECK_THROWS_AS(retime(posix_files(), root.path(), root.path()), InputError);
    for (int n = 1; n < 12; ++n) {
        test::FailingFiles files(n);
        CHECK_THROWS_AS(retime(files, root.path(), out), std::system_error);
        CHECK(std::filesystem::is_empty(parent.path()));
    }
    const RetimeReport report = retime(posix_files(), root.path(), out);
    CHECK(report.records > 0);
    CHECK(report.unsynchronised_runs == 1);  // Nothing corrects its times.
    CHECK(retime(posix_files(), root.path(), parent.path() / "again/").records > 0);
    CHECK(samples_of(records_in(out / "archive", "BNZ")) ==
          samples_of(records_in(parent.path() / "again" / "archive", "BNZ")));
}

TEST_CASE("a damaged segment is re-timed without the lost chunks, which are reported") {
    DataRoot root, parent;
    root.write_journal(badly_timed_session(0));
    const auto segment = journal::segment_files(root.journal()).front();
    std::filesystem::resize_file(segment, std::filesystem::file_size(segment) - 1000);
    const RetimeReport report = retime(posix_files(), root.path(), parent.path() / "better");
    REQUIRE(report.damage.size() == 1);
    CHECK(report.damage[0].file == segment);
    CHECK(report.records > 0);

    auto bytes = test::read_bytes(segment);
    const std::uint64_t frames = report.counters.frames;
    bytes[bytes.size() / 2] ^= std::byte{8};
    test::write_bytes(segment, bytes);
    const RetimeReport flipped = retime(posix_files(), root.path(), parent.path() / "flipped");
    CHECK(flipped.damage.size() == 2);
    std::printf("%llu of %llu frames behind a flipped bit\n",
                static_cast<unsigned long long>(flipped.counters.frames),
                static_cast<unsigned long long>(frames));
    CHECK(flipped.counters.frames < frames);
    CHECK(flipped.counters.frames + 100 > frames);
    CHECK(flipped.counters.gaps == report.counters.gaps + 1);

    std::ranges::fill(bytes, std::byte{0});
    test::write_bytes(segment, bytes);
    CHECK_THROWS_AS(retime(posix_files(), root.path(), parent.path() / "none"), std::runtime_error);
    CHECK_FALSE(std::filesystem::exists(parent.path() / "none"));
}

TEST_CASE(
    "records of a host without a clock stay in the journal until re-timing adds them to the "
    "archive") {
    // The host starts in 1970 and is synchronised after a minute.
    JournalStream stream;
    stream.frames(0, 9'000);
    for (journal::Chunk& chunk : stream.chunks) {
        auto* reading = std::get_if<timing::ClockReading>(&chunk);
        if (auto* header = std::get_if<journal::Header>(&chunk)) reading = &header->clock;
        if (reading == nullptr || reading->raw >= kRawStart + 60s) continue;
        reading->realtime -= kStart.time_since_epoch();
        reading->is_synchronised = false;
    }
    DataRoot root;
    root.write_journal(stream.chunks);
    archive_all(root, stream.chunks);
    for (const auto& record : root.records("BNZ")) CHECK(record.header.start > kStart);
    CHECK(root.counts("BNZ").size() < 6'100);
    CHECK(root.counts("BNZ").size() > 5'500);
    for (const auto& entry : std::filesystem::directory_iterator(root.archive()))
        CHECK(entry.path().filename() != "1970");

    test::TemporaryDirectory parent;
    static_cast<void>(retime(posix_files(), root.path(), parent.path() / "again"));
    CHECK(samples_of(records_in(parent.path() / "again" / "archive", "BNZ")).size() == 9'000);
}

TEST_CASE(
    "re-timed samples are right from the first one after a sleep of the host, however late the "
    "clock reading comes that shows the sleep") {
    constexpr Nanoseconds kSlept = 40s;
    constexpr std::int64_t kAsleepFrom = 3'010, kAwakeFrom = 5'010;
    for (const Nanoseconds late : {Nanoseconds(-20ms), Nanoseconds(30ms), Nanoseconds(200ms)}) {
        CAPTURE(late.count());
        const auto reading = [&](Nanoseconds now, Nanoseconds slept) {
            timing::ClockReading clock = clock_at(now);
            clock.boottime = clock.raw.time_since_epoch();
            clock.raw -= slept;
            return clock;
        };
        JournalStream stream;
        std::get<journal::Header>(stream.chunks.front()).clock = reading(0s, 0s);
        Nanoseconds slept{0};
        for (std::int64_t k = 0; k < 9'000; ++k) {
            if (k >= kAsleepFrom && k < kAwakeFrom) continue;
            if (k == kAwakeFrom) {
                slept = kSlept;
                stream.flush();
                stream.chunks.emplace_back(reading(due(k) + late, slept));
            }
            stream.bytes(frame_of(values_of(k)), due(k) - slept);
            if (k % 50 != 49) continue;
            stream.flush();
            stream.chunks.emplace_back(reading(due(k) + 1ms, slept));
        }
        stream.flush();
        DataRoot root, parent;
        root.write_journal(stream.chunks);
        const auto out = parent.path() / "better";
        CHECK(retime(posix_files(), root.path(), out).counters.gaps == 1);
        std::int64_t k = 0;
        for (const DecodedRecord& record : records_in(out / "archive", "BNZ")) {
            if (k == kAsleepFrom) k = kAwakeFrom;
            REQUIRE(std::chrono::abs(record.header.start - truth(k)) < Nanoseconds(500us));
            k += static_cast<std::int64_t>(record.samples.size());
        }
        CHECK(k == 9'000);
    }
}
