#include "daemon/store/disk_policy.hpp"

#include "daemon/store/archive_thread.hpp"
#include "daemon/store/journal_thread.hpp"

namespace a351::daemon::store {
namespace {

// Duration of a sync above which a power cut would cost more than the promised second.
constexpr std::chrono::seconds kStall{1};
// Free space below which the status warns.  Reason: 1 GiB lasts 9 days at 50 Hz, with 100 MB of
// journal and 15 MB of archive a day, so there is time for a remedy.
constexpr std::uint64_t kLittleSpace_bytes = std::uint64_t{1} << 30;
constexpr std::uint64_t kSpaceOfADay_bytes = 115'000'000;

}  // namespace

void report(const JournalStatus& journal, const ArchiveStatus& archive, const std::string& keeper,
            bool is_short, status::Status& status) {
    if (archive.is_replaying) {
        status.warn(text::message(
            "archive: the last run's data are being added from the journal; occupations can be "
            "started and stopped when this is finished"));
    }
    if (!keeper.empty())
        status.warn(text::message("closed journal segment: not compressed or removed: {}", keeper));
    if (!journal.trouble.empty()) {
        status.fail(text::message(
            "journal: {}; new data wait in memory and a power cut would lose them; check the disk",
            journal.trouble));
    }
    if (!archive.trouble.empty()) status.fail(text::message("archive: {}", archive.trouble));
    if (journal.is_dropping) {
        status.fail(text::message(
            "journal: writing has failed for so long that the buffer is full; the oldest data are "
            "being discarded; check the disk"));
    }
    if (archive.chunks_lost + archive.records_dropped > 0) {
        status.fail(text::message(
            "archive: some data could not be added; they are safe in the journal and will be added "
            "at the next start"));
    }
    if (!archive.metadata_trouble.empty())
        status.warn(text::message("metadata: {}", archive.metadata_trouble));
    if (!archive.is_marking) {
        status.warn(text::message(
            "archive: a sync failed or a chunk was lost, so newer data are not confirmed as "
            "archived; they are safe in the journal and will be added at the next start"));
    }
    if (journal.present_sync >= kStall) {
        status.warn(text::message(
            "the disk stalls: new data wait in memory and a power cut would lose them; check the "
            "disk"));
    }
    if (is_short) {
        status.fail(text::message(
            "disk full: the archive waits so that the journal can continue; make room"));
    } else if (!status.disk_free_bytes) {
        status.warn(text::message(
            "disk: the free space cannot be determined; check the disk of storage.root"));
    } else if (*status.disk_free_bytes < kSpaceOfADay_bytes) {
        status.warn(
            text::message("disk: nearly full, less than a day at 50 Hz is left; make room now"));
    } else if (*status.disk_free_bytes < kLittleSpace_bytes) {
        status.warn(
            text::message("disk: less than 1 GiB free, at most 9 days at 50 Hz; make room"));
    }
}

}  // namespace a351::daemon::store
