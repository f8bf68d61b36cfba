// Samples are decoded for the live view whatever the disk does.

#include "tests/unit/daemon/stepped_rig.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::status;
using namespace a351::daemon::store;

namespace {

struct ViewRig : Rig {
    std::atomic<std::int64_t> seen{-1};  ///< Last sample passed to the live view.

    [[nodiscard]] store::Options viewed() {
        store::Options viewed = options();
        viewed.sample = [this](const archive::Sample& sample, UtcTime) { seen = sample.index; };
        return viewed;
    }
    void see_new_samples(const char* disk) {
        for (int i = 0; i < 3; ++i) {
            feed(100);
            INFO(disk << ": the view has " << seen << " of " << fed << " samples");
            REQUIRE(eventually([&] { return seen == fed - 1; }));
        }
    }
};

}  // namespace

TEST_CASE_METHOD(ViewRig, "the live view continues while the journal's disk hangs") {
    Store store(files, viewed(), clock, reads);
    record_first(store);
    files.does_sync_hang = true;
    feed(100);
    REQUIRE(eventually([&] { return files.hanging == 1; }));
    const int written_at_most = fed;
    see_new_samples("sync hangs");
    const Status status = status_of(store);
    CHECK(status.received == fed - 1);
    CHECK(status.journaled < written_at_most);
    files.does_sync_hang = false;
    CHECK(eventually([&] { return status_of(store).journaled == fed - 1; }));
    CHECK(store.stop());
    CHECK(read_journal(root).bytes == bytes);
    CHECK(archived_counts(root, "BNZ") == expected_counts(fed));
}

TEST_CASE_METHOD(
    ViewRig,
    "the live view continues while the disk refuses the journal, which is complete later") {
    Store store(files, viewed(), clock, reads);
    record_first(store);
    files.does_append_fail = true;
    feed(kFrames);  // More than a record holds.
    see_new_samples("writing fails");
    const Status status = status_of(store);
    CHECK(status.level == Status::Level::fault);
    CHECK(status.journaled == 99);
    CHECK(status.more_counters.at("archive_records") == 0);  // None comes before its journal.
    CHECK(status.more_counters.at("archive_records_waiting") > 0);
    CHECK(eventually([&] { return status_of(store).more_counters["journal_faults"] > 3; }));
    files.does_append_fail = false;
    CHECK(eventually([&] { return status_of(store).journaled == fed - 1; }));
    CHECK(store.stop());
    for (const auto& segment : journal::segment_files(root / "journal"))
        CHECK(std::filesystem::file_size(segment) > 0);
    CHECK(read_journal(root).bytes == bytes);
    CHECK(archived_counts(root, "BNZ") == expected_counts(fed));
}

TEST_CASE_METHOD(ViewRig, "the live view continues while the archive's disk hangs") {
    Store store(files, viewed(), clock, reads);
    record_first(store);
    files.does_archive_hang = true;
    feed(kFrames);
    REQUIRE(eventually([&] { return files.archive_hanging == 1; }));
    see_new_samples("archive hangs");
    CHECK(eventually([&] { return status_of(store).journaled == fed - 1; }));
    files.does_archive_hang = false;
    CHECK(store.stop());
    CHECK(archived_counts(root, "BNZ") == expected_counts(fed));
}

TEST_CASE_METHOD(ViewRig,
                 "an archive that refuses more than memory holds stops nothing, and the next start "
                 "completes it") {
    {
        store::Options small = viewed();
        small.waiting_records_bytes = 8 << 10;  // 16 records.
        Store store(files, small, clock, reads);
        record_first(store);
        files.does_archive_fail = true;
        feed(5 * kFrames);
        see_new_samples("archive refuses");
        const Status status = status_of(store);
        CHECK(status.more_counters.at("archive_records_dropped") > 0);
        CHECK(status.more_counters.at("archive_records_waiting") <= 17);
        files.does_archive_fail = false;
        CHECK(eventually([&] { return status_of(store).journaled == fed - 1; }));
        static_cast<void>(store.stop());
    }
    CHECK(read_journal(root).bytes == bytes);
    CHECK(recover(files, options(), clock).records_conflicting == 0);
    CHECK(archived_counts(root, "BNZ") == expected_counts(fed));
    CHECK(samples_in_records(root, "BNZ") == static_cast<std::size_t>(fed));
}

TEST_CASE("samples that come 2 % too fast are another rate, until the next session") {
    SteppedRig rig;
    Store store(rig.files, rig.options(), rig.clock, rig.reads);
    rig.begin_session();
    rig.period = kPeriod * 50 / 51;
    rig.advance(store, std::chrono::seconds(40));
    CHECK_FALSE(status_of(store).wrong_rate);
    rig.advance(store, std::chrono::seconds(20));
    const auto rate = status_of(store).wrong_rate;
    REQUIRE(rate);
    CHECK(std::abs(rate->value() - 51.0) < 0.05);
    rig.begin_session(43);
    rig.advance(store, std::chrono::seconds(1));
    CHECK_FALSE(status_of(store).wrong_rate);
}
