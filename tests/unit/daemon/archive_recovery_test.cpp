// The archive gets all journaled samples although its disk fails or the process dies at the start.

#include <fstream>

#include "protocol/text/text_file.hpp"
#include "tests/unit/daemon/stepped_rig.hpp"
#include "tests/unit/files/failing_files.hpp"
#include "tests/unit/files/forgetful_files.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::status;
using namespace a351::daemon::store;
using std::chrono::seconds;

namespace {

/// Zeroes the last two records of each day file, as the kernel may drop them after a failed sync.
void zero_newest_records(const std::filesystem::path& root) {
    for (const char* channel : {"BN1", "BN2", "BNZ", "BK1"}) {
        for (const auto& file : archive::day_files(root / "archive", {}, channel)) {
            const auto lost = std::min(std::filesystem::file_size(file), 2 * archive::kRecordSize);
            std::fstream out(file, std::ios::binary | std::ios::in | std::ios::out);
            out.seekp(-static_cast<std::streamoff>(lost), std::ios::end);
            for (std::size_t i = 0; i < lost; ++i) out.put('\0');
        }
    }
}

struct RecoveryRig : SteppedRig {
    std::filesystem::path crashed = directory.path() / "crashed";

    /// Records a session of 60 s and keeps its files as a crash would leave them.
    /// @return options of a store for these files
    [[nodiscard]] store::Options crash() {
        test::FailingFiles unharmed;
        Store store(unharmed, options(), clock, reads);
        begin_session(1);
        advance(store, seconds(60));
        std::filesystem::copy(root, crashed, std::filesystem::copy_options::recursive);
        store::Options again = options();
        again.root = crashed;
        return again;
    }
    void check_archived_once(const std::filesystem::path& found) {
        CHECK(recorded_counts(found, "BN1") == stepped_counts(fed, 0));
        CHECK(recorded_counts(found, "BNZ") == stepped_counts(fed, 2));
    }
};

/// Files of a session of 40 s as a crash would leave them, and a store's options for them.
struct CrashedRig : Rig {
    std::atomic<seconds> later{seconds(0)};  ///< The clock of the next store is ahead by this.
    store::Options again = crashed();

private:
    store::Options crashed() {
        store::Options found = options();
        found.root = directory.path() / "crashed";
        found.time.now = [this] { return std::chrono::steady_clock::now() + later.load(); };
        Store store(files, options(), clock, reads);
        store.start();
        begin_session(1);
        feed(kFrames);
        REQUIRE(eventually([&] { return status_of(store).journaled == kFrames - 1; }));
        std::filesystem::copy(root, found.root, std::filesystem::copy_options::recursive);
        return found;
    }
};

}  // namespace

TEST_CASE_METHOD(CrashedRig,
                 "a replay that keeps failing is given up before the journal has to wait") {
    again.queue_bytes = std::size_t{256} << 10;  // About 6 000 frames.
    files.does_archive_fail = true;
    {
        Store store(files, again, clock, reads);
        store.start();
        begin_session(2);
        feed(kFrames);
        REQUIRE(eventually([&] { return status_of(store).more_counters["archive_faults"] > 1; }));
        CHECK_FALSE(has_reason(status_of(store), "given up until the next start"));
        feed(kFrames);  // More than half of the queue.
        REQUIRE(eventually(
            [&] { return has_reason(status_of(store), "given up until the next start"); }));
        const Status status = status_of(store);
        CHECK(status.level == Status::Level::fault);
        CHECK(status.more_counters.at("archive_waits") == 0);
        feed(4 * kFrames);  // More than the queue holds.
        REQUIRE(eventually([&] { return reads.fill() == 0; }));
        // The free space is the journal's concern too.
        for (const std::uint64_t free : {std::uint64_t{0}, std::uint64_t{1} << 30}) {
            files.free = free;
            later = later.load() + std::chrono::seconds(2);
            CHECK(eventually([&] { return has_reason(status_of(store), "disk full") == !free; }));
        }
        CHECK_FALSE(store.stop());
    }
    CHECK(read_journal(again.root).bytes == bytes);
    files.does_archive_fail = false;
    const auto report = recover(files, again, clock);
    CHECK(report.records_conflicting == 0);
    CHECK(recorded_counts(again.root, "BNZ") == expected_counts(fed));
}

TEST_CASE_METHOD(
    CrashedRig,
    "a replay stops when the remaining space becomes the journal's, and continues later") {
    std::filesystem::remove_all(again.root / "archive");
    files.does_archive_hang = true;
    Store store(files, again, clock, reads);
    store.start();
    REQUIRE(eventually([&] { return files.archive_hanging == 1; }));
    files.free = 0;
    later = std::chrono::seconds(2);
    const int looks = files.looks;
    CHECK(eventually([&] { return files.looks > looks; }));
    files.does_archive_hang = false;
    REQUIRE(eventually([&] {
        return has_reason(status_of(store), "the remaining space is kept for the journal");
    }));
    CHECK(recorded_counts(again.root, "BNZ").size() < kFrames);
    files.free = std::uint64_t{100} << 30;
    later = std::chrono::seconds(4);
    REQUIRE(eventually([&] { return !has_reason(status_of(store), "are being added"); }));
    CHECK(store.stop());
    CHECK(recorded_counts(again.root, "BNZ") == expected_counts(kFrames));
}

TEST_CASE_METHOD(
    RecoveryRig,
    "after a failed archive sync nothing is marked as archived, and the next start replays it") {
    {
        Store store(files, options(), clock, reads);
        begin_session();
        advance(store, seconds(20));
        files.does_archive_sync_fail = true;
        advance(store, seconds(20));
        REQUIRE(status_of(store).more_counters.at("archive_faults") > 0);
        files.does_archive_sync_fail = false;
        advance(store, seconds(60));
        const Status status = status_of(store);
        CHECK(status.level == Status::Level::warning);
        CHECK(has_reason(status, "newer data are not confirmed as archived"));
        CHECK_FALSE(status.archived);
        CHECK(store.stop());
    }
    CHECK(read_journal(root).marks.empty());
    zero_newest_records(root);
    recover(files, options(), clock);
    check_archived_once(root);
}

TEST_CASE_METHOD(
    RecoveryRig,
    "after a failed sync during a replay nothing is marked, and the next start replays it") {
    files.error_of_archive_sync = GENERATE(EIO, ENOSPC);  // network file systems report ENOSPC here
    const store::Options again = crash();
    const auto marks_before = read_journal(crashed).marks.size();
    {
        Store store(files, again, clock, reads);
        begin_session(2);
        files.does_archive_sync_fail = true;
        advance(store, seconds(5));
        REQUIRE(status_of(store).more_counters.at("archive_faults") > 0);
        files.does_archive_sync_fail = false;
        advance(store, seconds(60));
        const Status status = status_of(store);
        CHECK_FALSE(has_reason(status, "are being added from the journal"));
        CHECK(has_reason(status, "newer data are not confirmed as archived"));
        CHECK(store.stop());
    }
    CHECK(read_journal(crashed).marks.size() == marks_before);
    recover(files, again, clock);
    check_archived_once(crashed);
}

TEST_CASE("after a killed replay, a complete one and a power cut every sample is archived once") {
    std::mt19937_64 random(5);
    bool is_replayed = false;
    int kills = 0;
    for (int n = 0; !is_replayed; n += 1, ++kills) {
        RecoveryRig rig;
        {
            test::FailingFiles unharmed;
            Store store(unharmed, rig.options(), rig.clock, rig.reads);
            rig.begin_session(1);
            rig.advance(store, seconds(20));  // No MARK yet.
            std::filesystem::copy(rig.root, rig.crashed, std::filesystem::copy_options::recursive);
        }
        std::filesystem::remove_all(rig.crashed / "archive");  // A power cut may leave it so.
        std::filesystem::create_directory(rig.crashed / "archive");
        store::Options again = rig.options();
        again.root = rig.crashed;
        test::ForgetfulFiles forgetful;
        again.recovered = [&](const auto&) { is_replayed = true; };
        {
            Store store(forgetful, again, rig.clock, rig.reads);
            forgetful.operations_left = n;
            store.step();
        }
        forgetful.operations_left = std::numeric_limits<int>::max();
        again.recovered = [](const auto&) {};
        {
            Store store(forgetful, again, rig.clock, rig.reads);
            rig.begin_session(2);
            rig.advance(store, seconds(5));
            REQUIRE(store.stop());
        }
        const auto found = rig.directory.path() / "found";
        forgetful.cut(rig.crashed, found, random);
        INFO("killed after " << n << " operations of the replay");
        REQUIRE(read_journal(found).marks.back().session.bytes[0] == 2);
        again.root = found;
        recover(files::posix_files(), again, rig.clock);
        REQUIRE(recorded_counts(found, "BNZ") == stepped_counts(rig.fed, 2));
        REQUIRE(recorded_counts(found, "BN1") == stepped_counts(rig.fed, 0));
    }
    std::printf("replays killed: %d\n", kills);
}

TEST_CASE("a stop right after a stream has begun loses no sample when the stream is adopted") {
    // The range has stops before and after the times are fixed (ArrivalEdge::is_settled).
    const Nanoseconds begun = GENERATE(range(1, 13)) * kStep;
    CAPTURE(begun);
    RecoveryRig rig;
    rig.largest_lateness = std::chrono::milliseconds(15);
    for (const Nanoseconds span : {begun, Nanoseconds(seconds(40))}) {
        Store store(rig.files, rig.options(), rig.clock, rig.reads);
        rig.begin_session(1);
        rig.advance(store, span);
        CHECK(store.stop());
        CHECK(status_of(store).more_counters.at("archive_conflicts") == 0);
    }
    rig.check_archived_once(rig.root);
    const auto report = recover(rig.files, rig.options(), rig.clock);
    CHECK(report.records_conflicting == 0);
    CHECK(report.records_added == 0);
}

TEST_CASE_METHOD(RecoveryRig, "a host clock at 1970 starts no epoch of the station metadata") {
    const auto file = root / "metadata" / "station.xml";
    Store store(files, options(), clock, reads);
    const auto since_1970 = std::chrono::floor<std::chrono::days>(utc.time_since_epoch());
    begin_session(1, "A351", since_1970);
    advance(store, seconds(10));
    CHECK_FALSE(std::filesystem::exists(file));
    begin_session(2);  // Somebody set the clock.
    const UtcTime begun = utc;
    advance(store, seconds(10));
    REQUIRE(std::filesystem::exists(file));
    const auto xml = text::read_text_file(file);
    CHECK_THAT(xml, !ContainsSubstring("1970"));
    const auto start = begun - std::chrono::microseconds(63'875);  // group delay of k512_fc9
    CHECK_THAT(xml, ContainsSubstring("startDate=\"" + to_rfc3339(start, 6) + "\""));
    CHECK(store.stop());
}

TEST_CASE_METHOD(
    RecoveryRig,
    "records that a stop ended early are continued although another session follows soon") {
    {
        Store store(files, options(), clock, reads);
        begin_session(1);
        advance(store, seconds(60));
        REQUIRE(store.stop());
    }
    Store store(files, options(), clock, reads);
    begin_session(1);  // The stream was adopted.
    advance(store, seconds(2));
    begin_session(2);
    advance(store, seconds(20));
    CHECK(store.stop());
    CHECK(status_of(store).more_counters.at("archive_conflicts") == 0);
    check_archived_once(root);
}
