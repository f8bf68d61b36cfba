#include "daemon/store/journal_keeper.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "protocol/record/journal_reader.hpp"
#include "protocol/record/journal_writer.hpp"
#include "tests/unit/daemon/store_rig.hpp"
#include "tests/unit/record/failing_files.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace std::chrono_literals;

namespace {

constexpr JournalKeeper::Options kEager{.keep_days = 10, .compress_after = 0s, .interval = 10ms};

/// One segment a day.
struct Journal {
    TemporaryDirectory directory;
    std::filesystem::path path = directory.path() / "journal";

    explicit Journal(int days, bool is_synchronised = true) {
        record::JournalWriter writer(record::posix_files(), path);
        for (int day = 0; day < days; ++day) {
            record::JournalHeader header;
            header.clock.realtime = *parse_rfc3339("2026-03-01T12:00:00Z") + std::chrono::days(day);
            header.clock.is_synchronised = is_synchronised;
            writer.begin_segment(header);
            writer.append(record::EventChunk{std::string(5000, 'x')}, header.clock);
        }
        writer.sync();
    }
    [[nodiscard]] std::vector<std::uint64_t> numbers(const char* extension) const {
        std::vector<std::uint64_t> numbers;
        for (const auto& segment : record::journal_segments(path))
            if (segment.extension() == extension)
                numbers.push_back(*record::segment_number(segment));
        return numbers;
    }
};

using Numbers = std::vector<std::uint64_t>;

}  // namespace

TEST_CASE("closed segments are compressed, the newest is not", "[daemon][keeper]") {
    const Journal journal(4);
    JournalKeeper keeper(record::posix_files(), journal.path, kEager, [] { return 0; });
    keeper.tidy();
    CHECK(journal.numbers(".zst") == Numbers{1, 2, 3});
    CHECK(journal.numbers(".a351j") == Numbers{4});
    CHECK(keeper.status().compressed == 3);
    keeper.tidy();
    CHECK(keeper.status().compressed == 3);
}

TEST_CASE("what was written lately is not compressed", "[daemon][keeper]") {
    const Journal journal(4);
    JournalKeeper keeper(record::posix_files(), journal.path, {}, [] { return 0; });
    keeper.tidy();
    CHECK(journal.numbers(".zst").empty());
}

TEST_CASE("segments are removed when they are covered and old, in order", "[daemon][keeper]") {
    const Journal journal(20);
    std::uint64_t covered_below = 0;
    JournalKeeper keeper(record::posix_files(), journal.path, kEager,
                         [&] { return covered_below; });
    keeper.tidy();
    CHECK(journal.numbers(".zst").size() == 19);
    covered_below = 6;
    keeper.tidy();
    CHECK(journal.numbers(".zst").front() == 6);
    covered_below = 20;
    keeper.tidy();
    CHECK(journal.numbers(".zst").front() == 10);  // 9 ended 10 days before 20 began
    CHECK(keeper.status().removed == 9);
    CHECK(journal.numbers(".a351j") == Numbers{20});
}

TEST_CASE("nothing is removed by clocks that nobody set, nor when all is to be kept",
          "[daemon][keeper]") {
    const Journal journal(20, false);
    JournalKeeper keeper(record::posix_files(), journal.path, kEager, [] { return 20; });
    keeper.tidy();
    CHECK(keeper.status().removed == 0);
    const Journal kept(20);
    JournalKeeper::Options for_ever = kEager;
    for_ever.keep_days = 0;
    JournalKeeper other(record::posix_files(), kept.path, for_ever, [] { return 20; });
    other.tidy();
    CHECK(other.status().removed == 0);
}

TEST_CASE("a fault of the disk is counted, and the keeper goes on", "[daemon][keeper]") {
    const Journal journal(4);
    test::FailingFiles files(1);
    JournalKeeper keeper(files, journal.path, kEager, [] { return 0; });
    keeper.start();
    CHECK(eventually([&] { return keeper.status().compressed == 3; }));
    CHECK(keeper.status().faults == 1);
    CHECK_FALSE(keeper.status().trouble.empty());
}

TEST_CASE_METHOD(Rig, "a segment goes when the archive has it, and only then", "[daemon][keeper]") {
    StoreOptions tidy = options();
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
