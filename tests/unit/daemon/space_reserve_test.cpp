#include "daemon/store/space_reserve.hpp"

#include <sys/stat.h>

#include "tests/unit/daemon/small_disk.hpp"
#include "tests/unit/daemon/stepped_rig.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::status;
using namespace a351::daemon::store;
using std::chrono::seconds;
using State = SpaceReserve::State;

namespace {

constexpr std::uint64_t kKiB = 1024;
constexpr std::uint64_t kReserve = 64 * kKiB;  // 50 s of journal at 50 Hz.

struct SmallRig : SteppedRig {
    test::SmallDisk disk{std::uint64_t{2} << 30};  // Above 1 GiB free it is a good disk.

    [[nodiscard]] store::Options options() const {
        store::Options options = SteppedRig::options();
        options.reserve_bytes = kReserve;
        return options;
    }
    [[nodiscard]] bool is_archive_complete() const {
        return archived_counts(root, "BNZ") == stepped_counts(fed, 2) &&
               samples_in_records(root, "BNZ") == static_cast<std::size_t>(fed);
    }
    [[nodiscard]] std::string reserve(Store& store) const { return status_of(store).disk_reserve; }
    [[nodiscard]] std::filesystem::path reserve_file() const { return root / "state" / "reserve"; }
};

}  // namespace

TEST_CASE("the blocks of the reserve are really allocated") {
    const test::TemporaryDirectory directory;
    const auto file = directory.path() / "reserve";
    SpaceReserve reserve(files::posix_files(), file, 8 << 20);
    if (reserve.status().state == State::unavailable) WARN(reserve.status().trouble);
    REQUIRE(reserve.status().state == State::present);
    struct stat status {};
    REQUIRE(stat(file.c_str(), &status) == 0);
    CHECK(status.st_size == 8 << 20);
    CHECK(status.st_blocks * 512 >= 8 << 20);
    CHECK(reserve.give_up());
    CHECK_FALSE(std::filesystem::exists(file));
    CHECK_FALSE(reserve.give_up());
    CHECK(reserve.is_space_short());
    reserve.tend();
    CHECK(reserve.status().state == State::present);
    CHECK(reserve.status().times_given_up == 1);
}

TEST_CASE(
    "a reserve is made only if more than twice its size is free, and kept by the next start") {
    const test::TemporaryDirectory directory;
    test::SmallDisk disk(1000);
    disk.fill_up_to(200);
    {
        SpaceReserve reserve(disk, directory.path() / "reserve", 100);
        CHECK(reserve.status().state == State::given_up);
        CHECK(reserve.status().times_given_up == 0);
        disk.fill_up_to(201);
        reserve.tend();
        CHECK(reserve.status().state == State::present);
        CHECK_FALSE(reserve.is_space_short());
        disk.fill_up_to(99);
        reserve.tend();
        CHECK(reserve.status().state == State::present);
        CHECK(reserve.is_space_short());
    }
    disk.fill_up_to(0);
    SpaceReserve again(disk, directory.path() / "reserve", 100);
    CHECK(again.status().state == State::present);
    CHECK(again.give_up());
    CHECK(disk.free_bytes(directory.path()) == 100);
}

TEST_CASE("a file system that cannot reserve space is reported and delays nothing") {
    const test::TemporaryDirectory directory;
    test::SmallDisk disk(1000);
    disk.error_of_allocate = EOPNOTSUPP;
    SpaceReserve reserve(disk, directory.path() / "reserve", 100);
    CHECK(reserve.status().state == State::unavailable);
    CHECK(reserve.status().trouble.find("allocate") != std::string::npos);
    CHECK_FALSE(reserve.give_up());
    CHECK_FALSE(reserve.is_space_short());
}

TEST_CASE_METHOD(SmallRig,
                 "on a full disk the journal continues in the reserve, and the archive waits") {
    disk.error_when_full = GENERATE(ENOSPC, EDQUOT);  // No space, or none within the quota.
    Store store(disk, options(), clock, reads);
    begin_session();
    advance(store, seconds(60));
    CHECK(reserve(store) == "present");
    CHECK(status_of(store).level == Status::Level::good);
    disk.fill_up_to(0);
    advance(store, seconds(20));
    const Status full = status_of(store);
    CHECK(full.disk_reserve == "given_up");
    CHECK(full.more_counters.at("reserve_given_up") == 1);
    CHECK(full.more_counters.at("journal_faults") == 0);
    CHECK(full.more_counters.at("archive_faults") == 0);
    CHECK(full.more_counters.at("archive_records_waiting") > 0);
    CHECK(full.level == Status::Level::fault);
    CHECK(has_reason(full, "disk full"));
    CHECK(full.journaled.value() > fed - 60);
    CHECK_FALSE(std::filesystem::exists(reserve_file()));
    CHECK(commit(store, note_at(utc, "in the reserve")));
    CHECK(read_journal(root).bytes == bytes);

    disk.empty();
    advance(store, seconds(20));
    const Status free = status_of(store);
    CHECK(free.disk_reserve == "present");
    CHECK(free.level == Status::Level::good);
    CHECK(std::filesystem::file_size(reserve_file()) == kReserve);
    CHECK(store.stop());
    CHECK(is_archive_complete());
    CHECK(events::read_events(root / "events").events.size() == 1);
}

TEST_CASE_METHOD(SmallRig,
                 "after the reserve is used up nothing is lost once there is space again") {
    Store store(disk, options(), clock, reads);
    begin_session();
    advance(store, seconds(10));
    disk.fill_up_to(0);
    advance(store, seconds(200));
    const Status full = status_of(store);
    CHECK(full.more_counters.at("journal_faults") > 0);
    CHECK(full.journaled.value() < fed - 50 * 60);
    CHECK(full.journaled.value() > 50 * 40);
    disk.fill_up_to(0);  // Otherwise a short line would still find room.
    CHECK_FALSE(commit(store, note_at(utc, "nowhere")));
    for (const auto& segment : journal::segment_files(root / "journal")) {
        journal::Reader reader(segment);
        while (reader.next()) {
        }
        CHECK(reader.damage().empty());
    }

    disk.empty();
    advance(store, seconds(20));
    CHECK(status_of(store).level == Status::Level::good);
    CHECK(status_of(store).journaled.value() > fed - 60);
    CHECK(commit(store, note_at(utc, "again")));
    CHECK(store.stop());
    CHECK(read_journal(root).bytes == bytes);
    CHECK(is_archive_complete());
    CHECK(events::read_events(root / "events").events.size() == 1);
}

TEST_CASE_METHOD(
    SmallRig,
    "if the memory of waiting records is full, only the excess takes the journal's space") {
    constexpr std::uint64_t kMost = 4;  // Records.
    store::Options small = options();
    small.waiting_records_bytes = kMost * archive::kRecordSize;
    Store store(disk, small, clock, reads);
    begin_session();
    advance(store, seconds(10));
    disk.fill_up_to(kReserve - 1);
    CHECK(reserve(store) == "present");
    std::uint64_t most_waiting = 0;
    const auto before = archived_counts(root, "BNZ").size();
    for (int i = 0; i < 15; ++i) {
        advance(store, seconds(1));
        const auto waiting = status_of(store).more_counters.at("archive_records_waiting");
        CHECK(waiting <= kMost);
        CHECK(waiting >= most_waiting);
        most_waiting = waiting;
    }
    CHECK(has_reason(status_of(store), "disk full"));
    CHECK(most_waiting == kMost);
    CHECK(archived_counts(root, "BNZ").size() > before);
    CHECK(store.stop());
    CHECK(is_archive_complete());
}

TEST_CASE_METHOD(
    SmallRig, "a start on a full disk records to the journal, and recovers once there is space") {
    const auto crashed = directory.path() / "crashed";
    {
        Store store(disk, options(), clock, reads);
        begin_session();
        advance(store, seconds(60));
        std::filesystem::copy(root, crashed, std::filesystem::copy_options::recursive);
    }
    store::Options again = options();
    again.root = crashed;
    test::SmallDisk full(1024 * kKiB);
    full.fill_up_to(kReserve);
    Store store(full, again, clock, reads);
    begin_session(43);
    const int before = fed;
    advance(store, seconds(20));
    CHECK(reserve(store) == "given_up");
    CHECK(has_reason(status_of(store), "the last run's data are being added"));
    CHECK(archived_counts(crashed, "BNZ").size() < 2900);
    full.empty();
    advance(store, seconds(20));
    CHECK(store.stop());
    CHECK(archived_counts(crashed, "BNZ") == stepped_counts(fed, 2));
    CHECK(fed == before + 2000);
}
