#include <set>

#include "tests/unit/daemon/stepped_rig.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::status;
using namespace a351::daemon::store;

TEST_CASE_METHOD(
    Rig, "a sync that hangs for 10 s loses nothing, and its samples do not count as journaled") {
    std::atomic<std::chrono::seconds> stalled{std::chrono::seconds(0)};
    store::Options stalling = options();
    stalling.time.now = [&] { return std::chrono::steady_clock::now() + stalled.load(); };
    Store store(files, stalling, clock, reads);
    record_first(store);
    CHECK(status_of(store).longest_sync < std::chrono::seconds(10));

    files.does_sync_hang = true;
    feed(500);
    REQUIRE(eventually([&] { return status_of(store).received == 599 && files.hanging == 1; }));
    stalled = std::chrono::seconds(10);
    const Status hanging = status_of(store);
    CHECK(hanging.longest_sync >= std::chrono::seconds(10));
    CHECK(hanging.level == Status::Level::warning);
    CHECK(hanging.reasons.at(0).english().find("the disk stalls") == 0);
    CHECK(hanging.journaled == 99);
    feed(500);
    files.does_sync_hang = false;
    CHECK(eventually([&] { return status_of(store).journaled == 1099; }));
    const Status after = status_of(store);
    CHECK(after.longest_sync >= std::chrono::seconds(10));
    CHECK(after.level == Status::Level::good);
    CHECK(after.more_counters.at("journal_faults") == 0);
    CHECK(store.stop());
    CHECK(read_journal(root).bytes == bytes);
    CHECK(archived_counts(root, "BNZ") == expected_counts(fed));
}

TEST_CASE_METHOD(Rig, "the work of the disk is given for an hour after the first minute") {
    struct CountedFiles : TroubledFiles {
        [[nodiscard]] files::DiskWork work() const override { return {900'000, 120}; }
    } counted;
    SteadyTime now;
    store::Options timed = options();
    timed.time.now = [&] { return now; };
    Store store(counted, timed, clock, reads);
    now += std::chrono::seconds(59);
    CHECK(status_of(store).disk_work.syncs == 120);
    CHECK_FALSE(status_of(store).hourly_disk_work);
    now += std::chrono::seconds(61);
    const auto hourly = status_of(store).hourly_disk_work;
    REQUIRE(hourly);
    CHECK(hourly->bytes == 27'000'000);
    CHECK(hourly->syncs == 3600);
}

TEST_CASE_METHOD(Rig,
                 "a journal thread that stops is noticed, but one that waits for the disk is not") {
    {
        Store stepped(files, options(), clock, reads);
        CHECK_FALSE(stepped.is_alive());
        stepped.step();
        CHECK(stepped.is_alive());
        CHECK_FALSE(stepped.is_alive());
    }
    Store store(files, options(), clock, reads);
    record_first(store);
    CHECK(store.is_alive());
    CHECK(eventually([&] { return store.is_alive(); }));
    files.does_sync_hang = true;
    feed(100);
    REQUIRE(eventually([&] { return files.hanging == 1; }));
    for (int i = 0; i < 3; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        CHECK(eventually([&] { return store.is_alive(); }));
    }
    files.does_sync_hang = false;
    CHECK(store.stop());
}

struct SmallQueueRig : RecordingRig {
    SmallQueueRig() : RecordingRig(std::size_t{16} << 10) {}  // About 340 reads.
};

TEST_CASE_METHOD(
    SmallQueueRig,
    "if a disk refuses data for too long the journal keeps the newest, the archive all") {
    files.does_append_fail = true;
    for (int i = 0; i < 50; ++i) {
        feed(20);
        REQUIRE(eventually([&] { return reads.fill() == 0; }));
    }
    CHECK(status_of(store).level == Status::Level::fault);
    CHECK(has_reason(status_of(store), "the oldest data are being discarded"));
    files.does_append_fail = false;
    REQUIRE(eventually([&] { return status_of(store).journaled == 1099; }));
    const Status status = status_of(store);
    CHECK_FALSE(has_reason(status, "the oldest data are being discarded"));
    CHECK(store.stop());

    const std::size_t frame_size = bytes.size() / 1100;
    const auto journaled = read_journal(root).bytes;
    const std::size_t dropped = status.more_counters.at("reads_dropped");
    CHECK(dropped > 0);
    CHECK(dropped < 850);
    CHECK(journaled.size() / frame_size == 1100 - dropped);
    CHECK(std::equal(journaled.end() - static_cast<std::ptrdiff_t>(100 * frame_size),
                     journaled.end(), bytes.end() - static_cast<std::ptrdiff_t>(100 * frame_size)));
    CHECK(archived_counts(root, "BNZ") == expected_counts(1100));
}

TEST_CASE_METHOD(SmallQueueRig, "a session that begins while the disk refuses data is kept too") {
    files.does_append_fail = true;
    for (int i = 0; i < 50; ++i) {
        if (i == 20) begin_session(43);
        feed(20);
        REQUIRE(eventually([&] { return reads.fill() == 0; }));
    }
    files.does_append_fail = false;
    REQUIRE(eventually([&] { return reads.fill() == 0; }));
    CHECK(store.stop());
    journal::Sequence chunks(journal::segment_files(root / "journal"));
    std::set<std::uint8_t> sessions;
    while (const auto chunk = chunks.next()) {
        if (const auto* header = std::get_if<journal::Header>(&*chunk))
            sessions.insert(header->session.bytes[0]);
    }
    CHECK(sessions == std::set<std::uint8_t>{42, 43});
    CHECK(read_journal(root).bytes.size() / (bytes.size() / 1100) ==
          1100 - status_of(store).more_counters.at("reads_dropped"));
    CHECK(archived_counts(root, "BNZ").back() == expected_counts(1100).back());
}

TEST_CASE_METHOD(RecordingRig, "while the archive cannot be written the journal continues") {
    files.does_archive_fail = true;
    feed(kFrames);  // More than a record holds.
    REQUIRE(eventually([&] { return status_of(store).more_counters["archive_faults"] > 1; }));
    REQUIRE(eventually([&] { return status_of(store).journaled == 99 + kFrames; }));
    const Status troubled = status_of(store);
    CHECK(troubled.level == Status::Level::fault);
    CHECK(troubled.more_counters.at("archive_records_waiting") > 0);
    CHECK(troubled.more_counters.at("archive_waits") == 0);
    CHECK(read_journal(root).bytes == bytes);
    CHECK(archived_counts(root, "BNZ").empty());

    files.does_archive_fail = false;
    feed(1);
    REQUIRE(
        eventually([&] { return status_of(store).more_counters["archive_records_waiting"] == 0; }));
    CHECK(store.stop());
    CHECK(archived_counts(root, "BNZ") == expected_counts(fed));
    CHECK(status_of(store).archived == fed - 1);
}

TEST_CASE_METHOD(
    Rig, "an archive that fails to the end makes stop() fail, but the journal is complete") {
    {
        Store store(files, options(), clock, reads);
        store.start();
        files.does_archive_fail = true;
        begin_session();
        feed(kFrames);
        CHECK_FALSE(store.stop());
    }
    CHECK(read_journal(root).bytes == bytes);
    files.does_archive_fail = false;
    CHECK(recover(files, options(), clock).records_added > 0);
    CHECK(archived_counts(root, "BNZ") == expected_counts(kFrames));
}

TEST_CASE_METHOD(RecordingRig,
                 "an event that could not be written in time is withdrawn, not written later") {
    files.does_sync_hang = true;
    feed(100);
    REQUIRE(eventually([&] { return files.hanging == 1; }));
    events::Event event = note_at(clock.now());
    event.details["note"] = "late";
    try {
        store.commit(event);
        FAIL("committed while the disk hung");
    } catch (const std::system_error& error) {
        CHECK(error.code() == std::errc::timed_out);
    }
    files.does_sync_hang = false;
    event.details["note"] = "in time";
    store.commit(event);
    CHECK(store.stop());
    const JournalContent journal = read_journal(root);
    REQUIRE(journal.events.size() == 1);
    CHECK(journal.events[0] == events::to_json(event));
    CHECK(events::read_events(root / "events").events.size() == 1);
}

TEST_CASE_METHOD(RecordingRig,
                 "an event reaches a failing journal as soon as the journal can be written") {
    files.does_append_fail = true;
    events::Event event = note_at(clock.now());
    store.commit(event);
    store.commit(event);
    CHECK(events::read_events(root / "events").events.size() == 2);
    CHECK(read_journal(root).events.empty());
    files.does_append_fail = false;
    CHECK(store.stop());
    CHECK(read_journal(root).events.size() == 2);
    CHECK(status_of(store).more_counters["journal_faults"] > 0);
}

TEST_CASE_METHOD(RecordingRig, "an event log that cannot be written does not affect the journal") {
    events::Event event = note_at(clock.now());
    std::filesystem::create_directories(root / "events" /
                                        (to_rfc3339(event.utc).substr(0, 7) + ".jsonl"));
    CHECK_THROWS_AS(store.commit(event), std::system_error);
    feed(100);
    CHECK(eventually([&] { return status_of(store).journaled == 199; }));
    CHECK_THROWS_AS(store.commit(event), std::system_error);
    const Status status = status_of(store);
    CHECK(status.more_counters.at("events_refused") == 2);
    CHECK(status.more_counters.at("journal_faults") == 0);
    CHECK(store.stop());
    CHECK(read_journal(root).events.empty());
}

TEST_CASE_METHOD(Rig,
                 "data that the archive cannot take are in the journal, and the fault remains") {
    Store store(files, options(), clock, reads);
    store.start();
    begin_session(42, "nobody's");
    feed(100);
    REQUIRE(eventually([&] { return status_of(store).level == Status::Level::fault; }));
    CHECK_FALSE(store.stop());
    CHECK(status_of(store).level == Status::Level::fault);
    CHECK(read_journal(root).bytes == bytes);
}

namespace {

/// Returns by how much the clock was set, rounded to seconds, by each clock_step of the event log.
std::vector<double> clock_steps_s(const std::filesystem::path& root) {
    std::vector<double> steps;
    for (const events::Event& event : events::read_events(root / "events").events)
        if (event.type == "clock_step")
            steps.push_back(std::round(std::stod(event.details.at("by_s"))));
    return steps;
}

}  // namespace

TEST_CASE_METHOD(Rig,
                 "a clock that is set back while data arrive is named once, by its step or by the "
                 "first sample of a session that follows it at once") {
    constexpr std::chrono::seconds kSecond{1}, kBack{80};
    Store store(files, options(), clock, reads);
    record_first(store);
    feed(25);  // Times are fixed for a second of data, half of it after a reading.
    timing::ClockReading reading = clock.read();
    reading.is_synchronised = true;
    const auto record = [&](int count_s) {
        for (int i = 0; i < count_s; ++i) {
            reading.raw += kSecond;
            reading.boottime += kSecond;
            reading.realtime += kSecond;
            REQUIRE(reads.push_woken(reading));
            feed(50);
        }
    };
    record(120);
    reading.realtime -= kBack;
    SECTION("in a session, which follows it after a minute") {}
    SECTION("before a session") { begin_session(101, "A351", kBack); }
    record(200);
    CHECK(store.stop());
    CHECK(clock_steps_s(root) == std::vector<double>{-80.0});
}

TEST_CASE_METHOD(SteppedRig,
                 "a clock that is behind the recorded data is named once, at the start or after a "
                 "sleep, and all samples are archived") {
    std::optional<Store> store(std::in_place, files, options(), clock, reads);
    begin_session(1);
    advance(*store, std::chrono::seconds(60));
    CHECK(clock_steps_s(root).empty());
    SECTION("at the start, before the first sample") {
        CHECK(store->stop());
        const UtcTime before = utc;
        set_clock_back(std::chrono::seconds(40));
        store.reset();  // unlocks the data root
        store.emplace(files, options(), clock, reads);
        store->step();
        const auto step = status_of(*store).clock_step;
        REQUIRE(step);
        CHECK(std::abs(seconds_between(before, step->before)) < 1.0);
        CHECK(step->after == utc);
        begin_session(2);
        advance(*store, std::chrono::seconds(60));
        CHECK(store->stop());
        CHECK(clock_steps_s(root) == std::vector<double>{-40.0});
        CHECK(status_of(*store).more_counters.at("archive_conflicts") == 0);
        CHECK(recorded_counts(root, "BNZ") == stepped_counts(fed, 2));
    }
    SECTION("while it sleeps") {
        set_clock_back(std::chrono::minutes(10));
        begin_session(2);
        advance(*store, std::chrono::seconds(60));
        CHECK(store->stop());
        CHECK(clock_steps_s(root) == std::vector<double>{-600.0});
    }
    SECTION("a few seconds are the uncertainty of a clock") {
        CHECK(store->stop());
        set_clock_back(std::chrono::seconds(4));
        store.reset();  // unlocks the data root
        store.emplace(files, options(), clock, reads);
        begin_session(2);
        advance(*store, std::chrono::seconds(60));
        CHECK(store->stop());
        CHECK(clock_steps_s(root).empty());
    }
}
