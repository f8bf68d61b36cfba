#include "daemon/store/journal_keeper.hpp"

#include <algorithm>
#include "tests/support/catch.hpp"

#include "protocol/journal/journal_reader.hpp"
#include "protocol/journal/journal_writer.hpp"
#include "tests/unit/daemon/store_rig.hpp"
#include "tests/unit/files/failing_files.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::store;
using namespace std::chrono_literals;

namespace {

constexpr JournalKeeper::Options kEager{.keep_days = 10, .compress_after = 0s, .interval = 10ms};

/// A journal with one segment per day.  With sessions(n) each segment is a session of its own, and
/// the last one has a MARK.
struct Journal {
    test::TemporaryDirectory directory;
    std::filesystem::path path = directory.path() / "journal";

    struct Day {
        std::uint8_t session = 0;
        bool is_synchronised = true;
        bool has_mark = false;
    };
    explicit Journal(const std::vector<Day>& days) {
        journal::Writer writer(files::posix_files(), path);
        for (std::size_t day = 0; day < days.size(); ++day) {
            journal::Header header;
            header.session.bytes[0] = days[day].session;
            header.clock.realtime =
                *parse_rfc3339("2026-03-01T12:00:00Z") + std::chrono::days(static_cast<int>(day));
            header.clock.is_synchronised = days[day].is_synchronised;
            writer.begin_segment(header);
            writer.append(journal::EventChunk{std::string(5000, 'x')}, header.clock);
            if (days[day].has_mark)
                writer.append(journal::MarkChunk{header.session, {{"BNZ", 1, {}}}}, header.clock);
        }
        writer.sync();
    }
    [[nodiscard]] static std::vector<Day> sessions(int count) {
        std::vector<Day> days;
        for (int i = 1; i <= count; ++i)
            days.push_back({static_cast<std::uint8_t>(i), true, false});
        days.back().has_mark = true;
        return days;
    }
    [[nodiscard]] std::vector<std::uint64_t> numbers(const char* extension) const {
        std::vector<std::uint64_t> numbers;
        for (const auto& segment : journal::segment_files(path))
            if (segment.extension() == extension)
                numbers.push_back(*journal::segment_number(segment));
        return numbers;
    }
};

using Numbers = std::vector<std::uint64_t>;

}  // namespace

TEST_CASE("closed segments are compressed, the newest is not", "[daemon][keeper]") {
    const Journal journal(Journal::sessions(4));
    JournalKeeper keeper(files::posix_files(), journal.path, kEager);
    keeper.tidy();
    CHECK(journal.numbers(".zst") == Numbers{1, 2, 3});
    CHECK(journal.numbers(".a351j") == Numbers{4});
    CHECK(keeper.status().compressed == 3);
    keeper.tidy();
    CHECK(keeper.status().compressed == 3);
}

TEST_CASE("while names of segments must be kept none is compressed, but old ones are removed",
          "[daemon][keeper]") {
    const Journal journal(Journal::sessions(20));
    JournalKeeper keeper(files::posix_files(), journal.path, kEager);
    keeper.keep_names(true);
    keeper.tidy();
    CHECK(keeper.status().compressed == 0);
    CHECK(keeper.status().removed == 9);
    keeper.keep_names(false);
    keeper.tidy();
    CHECK(keeper.status().compressed > 0);
}

TEST_CASE("a segment that was written recently is not compressed", "[daemon][keeper]") {
    const Journal journal(Journal::sessions(4));
    JournalKeeper keeper(files::posix_files(), journal.path, {});
    keeper.tidy();
    CHECK(journal.numbers(".zst").empty());
}

TEST_CASE("sessions that ended long ago and are in the archive are removed", "[daemon][keeper]") {
    const Journal journal(Journal::sessions(20));
    JournalKeeper keeper(files::posix_files(), journal.path, kEager);
    keeper.tidy();
    CHECK(keeper.status().removed == 9);  // 9 ended 10 days before 20 began
    CHECK(journal.numbers(".zst").front() == 10);
    CHECK(journal.numbers(".a351j") == Numbers{20});
    keeper.tidy();
    CHECK(keeper.status().removed == 9);
}

TEST_CASE("segments that no later session's MARK covers are kept", "[daemon][keeper]") {
    auto days = Journal::sessions(20);
    days[19].has_mark = false;
    const auto removed_of = [&] {
        const Journal journal(days);
        JournalKeeper keeper(files::posix_files(), journal.path, kEager);
        keeper.tidy();
        return keeper.status().removed;
    };
    CHECK(removed_of() == 0);
    days[4].has_mark = true;
    CHECK(removed_of() == 4);
}

TEST_CASE("old segments of a session that lasted until recently are kept", "[daemon][keeper]") {
    auto days = Journal::sessions(20);
    for (std::size_t i = 5; i < 15; ++i) days[i].session = 77;
    const Journal journal(days);
    JournalKeeper keeper(files::posix_files(), journal.path, kEager);
    keeper.tidy();
    CHECK(keeper.status().removed == 5);
    for (std::size_t i = 5; i < 20; ++i) days[i].session = 77;
    const Journal longer(days);
    JournalKeeper other(files::posix_files(), longer.path, kEager);
    other.tidy();
    CHECK(other.status().removed == 5);
}

TEST_CASE("dates of an unsynchronised clock do not count, and keep_days = 0 removes nothing",
          "[daemon][keeper]") {
    auto days = Journal::sessions(20);
    days[3].is_synchronised = false;
    const Journal journal(days);
    JournalKeeper keeper(files::posix_files(), journal.path, kEager);
    keeper.tidy();
    CHECK(keeper.status().removed == 9);
    for (auto& day : days) day.is_synchronised = false;
    const Journal never(days);
    JournalKeeper other(files::posix_files(), never.path, kEager);
    other.tidy();
    CHECK(other.status().removed == 0);
    const Journal kept(Journal::sessions(20));
    JournalKeeper::Options for_ever = kEager;
    for_ever.keep_days = 0;
    JournalKeeper third(files::posix_files(), kept.path, for_ever);
    third.tidy();
    CHECK(third.status().removed == 0);
}

TEST_CASE("a segment without a header does not stop the removal of others", "[daemon][keeper]") {
    const Journal journal(Journal::sessions(20));
    std::filesystem::resize_file(journal::segment_files(journal.path)[4], 10);
    JournalKeeper keeper(files::posix_files(), journal.path, kEager);
    keeper.tidy();
    CHECK(keeper.status().removed == 8);
}

TEST_CASE("a disk fault is counted, and reported until the keeper has succeeded",
          "[daemon][keeper]") {
    const Journal journal(Journal::sessions(4));
    test::FailingFiles files(1);
    JournalKeeper keeper(files, journal.path, kEager);
    keeper.tidy();
    CHECK(keeper.status().compressed == 2);
    CHECK_FALSE(keeper.status().trouble.empty());
    keeper.start();
    CHECK(eventually([&] { return keeper.status().compressed == 3; }));
    CHECK(eventually([&] { return keeper.status().trouble.empty(); }));
    CHECK(keeper.status().faults == 1);
}

TEST_CASE_METHOD(Rig, "a segment is removed when the archive has its samples, and not before",
                 "[daemon][keeper]") {
    store::Options tidy = options();
    tidy.keeper = kEager;
    files.does_archive_fail = true;
    Store store(files, tidy, clock, reads);
    store.start();
    begin_session(1, "A351", std::chrono::days(40));
    feed(kFrames);
    begin_session(2, "A351", std::chrono::days(39));
    feed(kFrames);
    begin_session(3);
    feed(kFrames);
    REQUIRE(eventually(
        [&] { return status_of(store).more_counters["journal_segments_compressed"] == 2; }));
    CHECK(status_of(store).more_counters["journal_segments_removed"] == 0);
    CHECK(read_journal(root).bytes == bytes);
    files.does_archive_fail = false;
    CHECK(store.stop());
    REQUIRE(eventually(
        [&] { return status_of(store).more_counters["journal_segments_removed"] == 1; }));
    CHECK(samples_in_records(root, "BNZ") == 3 * kFrames);
}
