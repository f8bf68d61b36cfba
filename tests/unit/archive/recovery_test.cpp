#include "protocol/archive/recovery.hpp"

#include "tests/support/catch.hpp"

#include "tests/support/long_tests.hpp"
#include "tests/unit/archive/collector.hpp"
#include "tests/unit/archive/data_root.hpp"
#include "tests/unit/files/failing_files.hpp"

using namespace a351;
using namespace a351::archive;
using namespace a351::files;
using namespace a351::journal;
using namespace std::chrono_literals;

namespace {

/// Returns two minutes across midnight in three segments, with a gap, a flipped bit, clock readings
/// and polls of an oven.
std::vector<journal::Chunk> eventful_session() {
    const auto before = 12h - 60s;
    JournalStream stream(1, before);
    std::mt19937_64 random(5);
    for (std::int64_t k = 0; k < 6'000; ++k) {
        if (k >= 4'000 && k < 4'003) continue;
        auto frame = frame_of(values_of(k));
        if (k == 1'234) frame[7] ^= std::byte{0x40};
        const auto late = Nanoseconds(static_cast<std::int64_t>(random() % 16'000'000));
        stream.bytes(frame, before + due(k) + late);
        if (k % 50 == 49) stream.second(before + due(k) + 17ms);
        if (k % 50 == 24) {
            stream.oven(before + due(k), static_cast<std::uint16_t>(420 + random() % 5));
        }
        if (k == 2'024 || k == 4'525) {
            stream.flush();
            stream.chunks.emplace_back(header_at(before + due(k) + 17ms));
        }
    }
    stream.flush();
    return stream.chunks;
}

struct Recovered : RecoveryReport {
    archive::Counters replayed;
};

/// Recovers as the daemon does at its start, when no more samples come.
Recovered recover(FileLayer& files, const std::filesystem::path& root) {
    Recovered report;
    const RecoveryPlan plan = begin_recovery(files, root / "journal");
    report.journal = plan.cut;
    for (const Replay& replay : plan.replays) {
        archive::Writer writer(files, root / "archive", replay.codes);
        Archiver archiver(writer);
        const auto take = [&](const journal::Chunk& chunk) {
            archiver.take(chunk);
            return true;
        };
        RecoveryReport part;
        const bool is_whole = replay_journal(files, root / "archive", replay, writer, take, part);
        CHECK(is_whole);
        archiver.close_records();
        static_cast<void>(writer.sync());
        report.archive.insert(report.archive.end(), part.archive.begin(), part.archive.end());
        report.records_added += writer.records_written();
        report.records_confirmed += writer.records_skipped();
        report.records_conflicting += writer.replay_conflicts();
        report.replayed = archiver.counters();
    }
    return report;
}

void cut_archive(const DataRoot& root, std::mt19937_64& random, bool with_torn_bytes) {
    for (const auto& channel : channels_in(root.archive(), {})) {
        const auto days = day_files(root.archive(), {}, channel);
        const auto day = days.back();
        const auto records = std::filesystem::file_size(day) / kRecordSize;
        const auto kept = random() % (records + 1);
        auto size = kept * kRecordSize;
        if (with_torn_bytes && kept < records) size += random() % kRecordSize;
        std::filesystem::resize_file(day, size);
        if (size == 0) std::filesystem::remove(day);
    }
}

/// A data root with the journal and the archive of the same chunks.
struct Whole : DataRoot {
    explicit Whole(const std::vector<journal::Chunk>& chunks) {
        write_journal(chunks);
        archive_all(*this, chunks);
        reference = files();
    }
    std::map<std::string, std::vector<std::byte>> reference;
};

}  // namespace

TEST_CASE("a torn tail of the day before the newest is cut") {
    const Whole whole(eventful_session());
    for (const auto& channel : channels_in(whole.archive(), {})) {
        const auto days = day_files(whole.archive(), {}, channel);
        REQUIRE(days.size() == 2);  // as after a clock was set back over midnight
        auto torn = test::read_bytes(days.front());
        torn.resize(torn.size() + 100);
        test::write_bytes(days.front(), torn);
    }
    const auto report = recover(posix_files(), whole.path());
    CHECK(report.archive.size() == channels_in(whole.archive(), {}).size());
    CHECK(whole.files() == whole.reference);
}

TEST_CASE("an archive cut at any record, torn or not, is recovered to the same bytes") {
    const Whole whole(with_record_age(eventful_session(), GENERATE(60s, 1s)));
    const auto& reference = whole.reference;
    REQUIRE(reference.size() == 20);  // four channels and six derived ones, two days
    std::mt19937_64 random(1);
    for (int round = 0; round < 16; ++round) {
        DataRoot root;
        root.copy_from(whole);
        cut_archive(root, random, round % 2 == 1);
        const auto report = recover(posix_files(), root.path());
        REQUIRE(root.files() == reference);
        CHECK(report.records_conflicting == 0);
        const auto again = recover(posix_files(), root.path());
        CHECK(again.records_added == 0);
        CHECK(again.records_confirmed == report.records_added + report.records_confirmed);
        REQUIRE(root.files() == reference);
    }
    DataRoot root;
    root.copy_from(whole);
    std::filesystem::remove_all(root.archive());
    recover(posix_files(), root.path());
    CHECK(root.files() == reference);
}

TEST_CASE(
    "a journal torn at any byte is recovered to the archive of an undisturbed run that ended "
    "there") {
    const auto chunks = with_record_age(eventful_session(), GENERATE(60s, 1s));
    DataRoot whole;
    whole.write_journal(chunks);
    std::mt19937_64 random(2);
    for (int round = 0; round < 12; ++round) {
        DataRoot root, fresh;
        root.copy_from(whole);
        const auto newest = journal::segment_files(root.journal()).back();
        std::filesystem::resize_file(newest, random() % std::filesystem::file_size(newest));
        fresh.copy_from(root);
        // The reference is the archive of a run with the same chunks.
        std::vector<journal::Chunk> seen;
        for (const auto& segment : journal::segment_files(fresh.journal())) {
            journal::Reader reader(segment);
            while (auto chunk = reader.next()) seen.push_back(std::move(*chunk));
        }
        archive_all(fresh, seen);
        const auto reference = fresh.files();
        // A part of that archive is on disk before the recovery.
        std::filesystem::copy(fresh.archive(), root.archive(),
                              std::filesystem::copy_options::recursive);
        cut_archive(root, random, true);
        recover(posix_files(), root.path());
        REQUIRE(root.files() == reference);
        CHECK(recover(posix_files(), root.path()).records_added == 0);
    }
}

TEST_CASE("a recovery killed at any change to the disk, twice, ends with the same bytes") {
    const Whole whole(with_record_age(eventful_session(), GENERATE(60s, 1s)));
    const auto& reference = whole.reference;
    std::mt19937_64 random(3);
    DataRoot crashed;
    crashed.copy_from(whole);
    for (const auto& channel : channels_in(crashed.archive(), {}))
        std::filesystem::remove(day_files(crashed.archive(), {}, channel).back());
    cut_archive(crashed, random, true);
    test::FailingFiles unharmed;
    {
        DataRoot root;
        root.copy_from(crashed);
        recover(unharmed, root.path());
        REQUIRE(root.files() == reference);
    }
    const int stride = test::is_long() ? 2 : 7;
    for (int change = 1; change <= unharmed.operations(); change += stride) {
        DataRoot root;
        root.copy_from(crashed);
        INFO("killed at change " << change);
        for (const int at : {change, 1 + change / 2}) {
            test::FailingFiles files(at);
            try {
                recover(files, root.path());
            } catch (const std::system_error&) {
            }
        }
        recover(posix_files(), root.path());
        REQUIRE(root.files() == reference);
    }
}

TEST_CASE("a replay agrees with records that an earlier shutdown had ended early") {
    // The daemon stops after sample 1499, starts again, continues the stream in the same session
    // and is killed later. The journal alone would give records that end elsewhere.
    JournalStream before, after;
    before.frames(0, 1'510);
    after.frames(1'510, 3'700);
    after.chunks.front() = header_at(due(1'509));
    const auto age = GENERATE(60s, 1s);
    before.chunks = with_record_age(before.chunks, age);
    after.chunks = with_record_age(after.chunks, age);
    DataRoot root;
    root.write_journal(joined(before.chunks, after.chunks));
    {
        archive::Writer writer(posix_files(), root.archive(), {});
        Archiver archiver(writer);
        for (const auto& chunk : before.chunks) archiver.take(chunk);
        archiver.close_records();
        for (const auto& chunk : after.chunks) archiver.take(chunk);
    }
    const auto report = recover(posix_files(), root.path());
    CHECK(report.records_conflicting == 0);
    CHECK(report.records_added > 0);
    CHECK(root.counts("BNZ") == expected(2, 0, 3'700));
    CHECK(recover(posix_files(), root.path()).records_added == 0);
}

TEST_CASE("replays agree with the archive wherever a shutdown ended the slow records") {
    // LCE gets its seconds when a record of BN1 ends. At a shutdown this is sooner than in a
    // replay, where an LCE record may reach its age limit before it has them.
    const auto stop_s = GENERATE(range(48, 75));
    const auto away_s = GENERATE(0, 8);
    CAPTURE(stop_s, away_s);
    const std::int64_t stopped = 50 * stop_s + 10, back = stopped + 50 * away_s;
    JournalStream before, after;
    before.frames(0, stopped);
    after.frames(back, 10'000);
    after.chunks.front() = header_at(due(back - 1));
    const auto age = GENERATE(60s, 1s);
    before.chunks = with_record_age(before.chunks, age);
    after.chunks = with_record_age(after.chunks, age);
    DataRoot root;
    root.write_journal(before.chunks);
    archive_all(root, before.chunks);
    {
        // The second run continues the stream, and also stops.
        archive::Writer writer(posix_files(), root.archive(), {});
        Archiver archiver(writer);
        writer.begin_replay();
        for (const auto* chunks : {&before.chunks, &after.chunks})
            for (const auto& chunk : *chunks) archiver.take(chunk);
        archiver.close_records();
        CHECK(writer.replay_conflicts() == 0);
    }
    const auto archived = root.files();
    const auto chunks = joined(before.chunks, after.chunks);
    std::filesystem::remove_all(root.journal());
    root.write_journal(chunks);
    const auto report = recover(posix_files(), root.path());
    CHECK(report.records_conflicting == 0);
    CHECK(report.records_added == 0);
    CHECK(root.files() == archived);
    CHECK(root.counts("LCE").size() == archive::archived(chunks).sink.counts("LCE").size());
}

TEST_CASE("an archive ahead of the journal keeps its records, and none is written twice") {
    JournalStream stream;
    stream.frames(0, 3'000);
    DataRoot root;
    archive_all(root, stream.chunks);
    const auto reference = root.files();
    stream.chunks.resize(stream.chunks.size() / 2);
    root.write_journal(stream.chunks);
    recover(posix_files(), root.path());
    CHECK(root.files() == reference);

    const DataRoot empty;
    CHECK(recover(posix_files(), empty.path()).records_added == 0);
    CHECK(empty.files().empty());
}

TEST_CASE("sessions that were not archived and synced before the newest mark are also replayed") {
    JournalStream first(1), second(2, 100s), third(3, 200s);
    first.frames(0, 2'000);
    second.frames(0, 2'000, 100s);
    second.chunks.emplace_back(MarkChunk{header_at(0s, 2).session, {{"BNZ", 10, kStart}}});
    third.frames(0, 2'000, 200s);
    DataRoot root;
    root.write_journal(joined(joined(first.chunks, second.chunks), third.chunks));
    const auto report = recover(posix_files(), root.path());
    CHECK(report.replayed.sessions == 2);
    auto counts = expected(2, 0, 2'000);
    const auto again = counts;
    counts.insert(counts.end(), again.begin(), again.end());
    CHECK(root.counts("BNZ") == counts);
}

TEST_CASE("sessions with other station codes are also recovered, each into its own archive") {
    JournalStream first(1), second(2, 100s);
    first.frames(0, 2'000);
    StationCodes other;
    other.station = "B351";
    std::get<journal::Header>(second.chunks.front()).codes = other;
    second.frames(0, 1'000, 100s);
    DataRoot root;
    root.write_journal(joined(first.chunks, second.chunks));
    CHECK(recover(posix_files(), root.path()).records_conflicting == 0);
    CHECK(root.counts("BNZ") == expected(2, 0, 2'000));
    CHECK(root.counts("BNZ", other) == expected(2, 0, 1'000));
}
