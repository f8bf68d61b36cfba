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

}  // namespace

TEST_CASE("record numbers of a channel continue across day files and restarts",
          "[record][archive_writer]") {
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

TEST_CASE("record numbers continue after a clock was set back over midnight and a restart",
          "[record][archive_writer]") {
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

TEST_CASE("the record number after 999999 is 1", "[record][archive_writer]") {
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

TEST_CASE("sync returns the last sample of each channel that is safe on disk",
          "[record][archive_writer]") {
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

TEST_CASE("a replayed record that the archive already has is skipped", "[record][archive_writer]") {
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
    "a replayed record that contradicts or overlaps the archive is a conflict and is not written",
    "[record][archive_writer]") {
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

TEST_CASE("a replay writes records into the time of an older session, when a clock was set back",
          "[record][archive_writer]") {
    DataRoot root;
    {
        archive::Writer writer(posix_files(), root.archive(), {});
        writer.record("BNZ", record_at(kStart, {1, 2, 3}), 2);  // This record belongs to an older session.
        writer.record("BNZ", record_at(kStart - 60ms, {11, 12}), 1);
        writer.record("BNZ", record_at(kStart - 20ms, {13}), 2);
    }
    archive::Writer writer(posix_files(), root.archive(), {});
    writer.begin_replay();
    writer.record("BNZ", record_at(kStart - 60ms, {11, 12}), 1);
    writer.record("BNZ", record_at(kStart - 20ms, {13}), 2);
    writer.record("BNZ", record_at(kStart, {14, 15}), 4);
    writer.settle();
    CHECK(writer.records_skipped() == 2);
    CHECK(writer.replay_conflicts() == 0);
    CHECK(writer.records_written() == 1);
    CHECK(writer.sync().at(0).index == 4);
}

TEST_CASE("a replay writes records into the time of an older session beyond a midnight",
          "[record][archive_writer]") {
    DataRoot root;
    const UtcTime midnight = std::chrono::ceil<std::chrono::days>(kStart);
    const auto after_midnight = record_at(midnight + 1s, {11, 12});
    {
        archive::Writer writer(posix_files(), root.archive(), {});
        writer.record("BNZ", record_at(midnight - 1s, {1, 2, 3}), 2);  // It is of an older session.
        writer.record("BNZ", after_midnight, 1);
    }
    archive::Writer writer(posix_files(), root.archive(), {});
    writer.begin_replay();
    writer.record("BNZ", after_midnight, 1);
    writer.record("BNZ", record_at(midnight - 1s + 20ms, {13, 14}), 3);  // The clock was set back.
    writer.settle();
    CHECK(writer.replay_conflicts() == 0);
    CHECK(writer.records_written() == 1);
    CHECK(writer.sync().at(0).index == 3);
}

TEST_CASE("a replay fills a hole before records that a set-back clock put into its time",
          "[record][archive_writer]") {
    DataRoot root;
    {
        archive::Writer writer(posix_files(), root.archive(), {});
        writer.record("BNZ", record_at(kStart, {1, 2, 3}), 2);
        // A failed sync lost the record that followed.
        writer.record("BNZ", record_at(kStart + 120ms, {7, 8}), 7);
        writer.record("BNZ", record_at(kStart + 60ms, {9, 10}), 9);  // The clock was set back.
    }
    archive::Writer writer(posix_files(), root.archive(), {});
    writer.begin_replay();
    writer.record("BNZ", record_at(kStart, {1, 2, 3}), 2);
    writer.record("BNZ", record_at(kStart + 60ms, {4, 5, 6}), 5);
    CHECK(writer.records_written() == 0);  // The next match decides.
    writer.record("BNZ", record_at(kStart + 120ms, {7, 8}), 7);
    CHECK(writer.records_written() == 1);
    writer.record("BNZ", record_at(kStart + 60ms, {9, 10}), 9);
    CHECK(writer.records_skipped() == 3);
    CHECK(writer.replay_conflicts() == 0);
    CHECK(writer.sync().at(0).index == 9);
}

TEST_CASE("a replay beyond the archived times still knows the records that a set-back clock wrote",
          "[record][archive_writer]") {
    DataRoot root;
    const auto first = record_at(kStart, {1, 2, 3});
    const auto third = record_at(kStart - 60ms, {7, 8});
    {
        archive::Writer writer(posix_files(), root.archive(), {});
        writer.record("BNZ", first, 2);  // The record that followed was dropped.
        writer.record("BNZ", third, 7);
    }
    archive::Writer writer(posix_files(), root.archive(), {});
    writer.begin_replay();
    writer.record("BNZ", first, 2);
    writer.record("BNZ", record_at(kStart + 60ms, {4, 5, 6}), 5);
    writer.record("BNZ", third, 7);
    writer.settle();
    CHECK(writer.records_written() == 1);
    CHECK(writer.records_skipped() == 2);
}

TEST_CASE("a record of the last session that is written late is not reported for the next",
          "[record][archive_writer]") {
    DataRoot root;
    archive::Writer(posix_files(), root.archive(), {})
        .record("BNZ", record_at(kStart, {1, 2, 3}), 2);
    archive::Writer writer(posix_files(), root.archive(), {});
    writer.begin_replay();
    writer.record("BNZ", record_at(kStart + 40ms, {9}), 900);
    writer.begin_session();
    writer.record("BNZ", record_at(kStart, {1, 2, 3}), 2);  // It shows that nothing is in the place.
    CHECK(writer.records_written() == 1);
    CHECK(writer.sync().at(0).index == 2);
}
