#include "daemon/store/journal_keeper.hpp"

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

/// Returns how many segments a keeper removes from a new journal.
std::uint64_t removed_of(const std::vector<Journal::Day>& days,
                         const JournalKeeper::Options& options = kEager) {
    const Journal journal(days);
    JournalKeeper keeper(files::posix_files(), journal.path, options);
    keeper.tidy();
    return keeper.status().removed;
}

}  // namespace

TEST_CASE("closed segments are compressed, the newest and recently written ones are not") {
    const Journal journal(Journal::sessions(4));
    JournalKeeper patient(files::posix_files(), journal.path, {});
    patient.tidy();
    CHECK(journal.numbers(".zst").empty());
    JournalKeeper keeper(files::posix_files(), journal.path, kEager);
    for (int i = 0; i < 2; ++i) {
        keeper.tidy();
        CHECK(journal.numbers(".zst") == Numbers{1, 2, 3});
        CHECK(journal.numbers(".a351j") == Numbers{4});
        CHECK(keeper.status().compressed == 3);
    }
}

TEST_CASE("while names of segments must be kept none is compressed, but old ones are removed") {
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

TEST_CASE("sessions that ended long ago and are in the archive are removed") {
    const Journal journal(Journal::sessions(20));
    JournalKeeper keeper(files::posix_files(), journal.path, kEager);
    for (int i = 0; i < 2; ++i) {
        keeper.tidy();
        CHECK(keeper.status().removed == 9);  // 9 ended 10 days before 20 began
        CHECK(journal.numbers(".zst").front() == 10);
        CHECK(journal.numbers(".a351j") == Numbers{20});
    }
    JournalKeeper::Options for_ever = kEager;
    for_ever.keep_days = 0;
    CHECK(removed_of(Journal::sessions(20), for_ever) == 0);
}

TEST_CASE("segments without a later MARK, of a lasting session or of no known date are kept") {
    const auto days = Journal::sessions(20);
    auto marked = days;
    marked[19].has_mark = false;
    CHECK(removed_of(marked) == 0);
    marked[4].has_mark = true;
    CHECK(removed_of(marked) == 4);

    for (const std::size_t end : {15U, 20U}) {
        auto lasting = days;
        for (std::size_t i = 5; i < end; ++i) lasting[i].session = 77;
        CHECK(removed_of(lasting) == 5);
    }

    auto undated = days;
    undated[3].is_synchronised = false;
    CHECK(removed_of(undated) == 9);
    for (auto& day : undated) day.is_synchronised = false;
    CHECK(removed_of(undated) == 0);
}

TEST_CASE("a segment without a header does not stop the removal of others") {
    const Journal journal(Journal::sessions(20));
    std::filesystem::resize_file(journal::segment_files(journal.path)[4], 10);
    JournalKeeper keeper(files::posix_files(), journal.path, kEager);
    keeper.tidy();
    CHECK(keeper.status().removed == 8);
}

TEST_CASE("a disk fault is counted, and reported until the keeper has succeeded") {
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

TEST_CASE_METHOD(Rig, "a segment is removed when the archive has its samples, and not before") {
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
