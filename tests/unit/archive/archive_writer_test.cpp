#include "protocol/archive/archive_writer.hpp"

#include "tests/support/catch.hpp"

#include "tests/unit/archive/data_root.hpp"

using namespace a351;
using namespace a351::archive;
using namespace a351::files;
using namespace a351::journal;
using namespace std::chrono_literals;

namespace {

PackedRecord record_at(UtcTime start, std::vector<std::int32_t> samples) {
    RecordHeader header;
    header.network = "XX";
    header.station = "A351";
    header.location = "00";
    header.channel = "BNZ";
    header.start = start;
    header.nominal_rate = Hertz(50);
    return pack_record(header, samples);
}

std::vector<int> sequences(const DataRoot& root) {
    std::vector<int> all;
    for (const auto& record : root.records("BNZ")) all.push_back(record.header.sequence);
    return all;
}

/// A record of z that starts this long after kStart, and its last index.
struct Written {
    Nanoseconds start{0};
    std::vector<std::int32_t> samples;
    std::int64_t last = 0;
};

void write(archive::Writer& writer, const std::vector<Written>& records) {
    for (const auto& [start, samples, last] : records)
        writer.record("BNZ", record_at(kStart + start, samples), last);
}

}  // namespace

TEST_CASE("record numbers of a channel continue across day files and restarts") {
    DataRoot root;
    for (int run = 0; run < 3; ++run) {
        archive::Writer writer(posix_files(), root.archive(), {});
        for (int i = 0; i < 2; ++i) {
            const auto start = kStart + run * 24h + i * 1min;
            writer.record("BNZ", record_at(start, {1, 2, 3}), 3 * i + 2);
        }
        CHECK(writer.records_written() == 2);
    }
    CHECK(sequences(root) == std::vector{1, 2, 3, 4, 5, 6});
}

TEST_CASE("record numbers continue after a clock was set back over midnight and a restart") {
    DataRoot root;
    const UtcTime today(std::chrono::ceil<std::chrono::days>(kStart.time_since_epoch()));
    const auto record = [&root](std::vector<UtcTime> starts) {
        archive::Writer writer(posix_files(), root.archive(), {});
        for (const UtcTime start : starts) writer.record("BNZ", record_at(start, {1, 2, 3}), 2);
    };
    record({today - 2min, today + 1min, today - 1min});  // The clock is set back before the last.
    record({today - 30s, today + 2min});
    CHECK(sequences(root) == std::vector{1, 3, 4, 2, 5});
}

TEST_CASE("the record number after 999999 is 1") {
    DataRoot root;
    RecordHeader header = decode_record(record_at(kStart, {1}).bytes)->header;
    header.sequence = 999'998;
    const std::vector<std::int32_t> samples{1};
    SdsWriter(posix_files(), root.archive(), {}).append("BNZ", pack_record(header, samples));
    archive::Writer writer(posix_files(), root.archive(), {});
    writer.record("BNZ", record_at(kStart + 1min, {1}), 1);
    writer.record("BNZ", record_at(kStart + 2min, {1}), 2);
    CHECK(sequences(root) == std::vector{999'998, 999'999, 1});
}

TEST_CASE("sync returns the last sample of each channel that is safe on disk") {
    DataRoot root;
    archive::Writer writer(posix_files(), root.archive(), {});
    CHECK(writer.sync().empty());
    writer.record("BNZ", record_at(kStart, {1, 2, 3}), 102);
    const auto marks = writer.sync();
    REQUIRE(marks.size() == 1);
    CHECK(marks[0].channel == "BNZ");
    CHECK(marks[0].index == 102);
    CHECK(marks[0].utc == kStart + 40ms);
}

TEST_CASE("a replayed record that the archive already has is skipped") {
    DataRoot root;
    const auto held = record_at(kStart, {1, 2, 3});
    const auto next = record_at(kStart + 60ms, {4, 5});
    archive::Writer(posix_files(), root.archive(), {}).record("BNZ", held, 2);
    const auto before = root.files();

    archive::Writer writer(posix_files(), root.archive(), {});
    writer.begin_replay();
    CHECK(writer.samples_in_archive("BNZ", kStart) == 3);
    CHECK_FALSE(writer.samples_in_archive("BNZ", kStart + 60ms));
    CHECK_FALSE(writer.samples_in_archive("BN1", kStart));
    writer.record("BNZ", held, 2);
    CHECK(root.files() == before);
    CHECK(writer.records_skipped() == 1);
    writer.record("BNZ", next, 4);
    CHECK(writer.records_written() == 1);
    CHECK(sequences(root) == std::vector{1, 2});
    CHECK(writer.sync().at(0).index == 4);
}

TEST_CASE(
    "a replayed record that contradicts or overlaps the archive is a conflict and is not written") {
    DataRoot root;
    archive::Writer(posix_files(), root.archive(), {})
        .record("BNZ", record_at(kStart, {1, 2, 3}), 2);
    const auto before = root.files();
    archive::Writer writer(posix_files(), root.archive(), {});
    writer.begin_replay();
    writer.record("BNZ", record_at(kStart, {1, 2, 4}), 2);
    writer.record("BNZ", record_at(kStart, {1, 2}), 1);
    writer.record("BNZ", record_at(kStart + 20ms, {2, 3}), 2);
    writer.record("BNZ", record_at(kStart - 20ms, {0, 1}), 0);
    writer.settle();
    CHECK(root.files() == before);
    CHECK(writer.replay_conflicts() == 4);
    CHECK(writer.records_written() == 0);

    CHECK(writer.sync().empty());  // No record was written, so no sample is reported as safe.

    writer.end_replay();
    writer.record("BNZ", record_at(kStart + 20ms, {2, 3}), 2);
    CHECK(writer.records_written() == 1);
}

TEST_CASE("a replay writes what the archive lacks, in whatever order a set-back clock put it") {
    struct Case {
        const char* name;
        std::vector<Written> archived, replayed;
        std::uint64_t skipped;
        std::int64_t safe;  ///< Last index that is reported as safe; one record is written.
    };
    const Written older{0ms, {1, 2, 3}, 2};
    const Written first{-60ms, {11, 12}, 1}, second{-20ms, {13}, 2};
    const Nanoseconds midnight = std::chrono::ceil<std::chrono::days>(kStart) - kStart;
    const Written after_midnight{midnight + 1s, {11, 12}, 1};
    const Written behind_hole{120ms, {7, 8}, 7}, set_back{60ms, {9, 10}, 9};
    for (const auto& [name, archived, replayed, skipped, safe] : {
             Case{"into the time of an older session",
                  {older, first, second},
                  {first, second, {0ms, {14, 15}, 4}},
                  2,
                  4},
             Case{"into that of an older session before midnight",
                  {{midnight - 1s, {1, 2, 3}, 2}, after_midnight},
                  {after_midnight, {midnight - 980ms, {13, 14}, 3}},
                  1,
                  3},
             Case{"into a hole that a failed sync left, whose time was repeated",
                  {older, behind_hole, set_back},
                  {older, {60ms, {4, 5, 6}, 5}, behind_hole, set_back},
                  3,
                  9},
             Case{"behind the archived times, with earlier ones after it",
                  {older, {-60ms, {7, 8}, 7}},
                  {older, {60ms, {4, 5, 6}, 5}, {-60ms, {7, 8}, 7}},
                  2,
                  7},
         }) {
        CAPTURE(name);
        DataRoot root;
        {
            archive::Writer writer(posix_files(), root.archive(), {});
            write(writer, archived);
        }
        archive::Writer writer(posix_files(), root.archive(), {});
        writer.begin_replay();
        write(writer, replayed);
        writer.settle();
        CHECK(writer.records_written() == 1);
        CHECK(writer.records_skipped() == skipped);
        CHECK(writer.replay_conflicts() == 0);
        CHECK(writer.sync().at(0).index == safe);
    }
}

TEST_CASE("a record that may be in the archive is written when the next match decides") {
    const Written held{0ms, {1, 2, 3}, 2};
    DataRoot root;
    {
        archive::Writer writer(posix_files(), root.archive(), {});
        write(writer, {held, {120ms, {7, 8}, 7}, {60ms, {9, 10}, 9}});
    }
    archive::Writer writer(posix_files(), root.archive(), {});
    writer.begin_replay();
    write(writer, {held, {60ms, {4, 5, 6}, 5}});
    CHECK(writer.records_written() == 0);
    write(writer, {{120ms, {7, 8}, 7}});
    CHECK(writer.records_written() == 1);

    DataRoot other;  // A record of the last session is not reported for the next.
    archive::Writer(posix_files(), other.archive(), {})
        .record("BNZ", record_at(kStart, {1, 2, 3}), 2);
    archive::Writer next(posix_files(), other.archive(), {});
    next.begin_replay();
    write(next, {{40ms, {9}, 900}});
    next.begin_session();
    write(next, {held});  // It shows that nothing is in the place.
    CHECK(next.records_written() == 1);
    CHECK(next.sync().at(0).index == 2);
}
