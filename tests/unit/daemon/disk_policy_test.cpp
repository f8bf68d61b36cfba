#include "daemon/store/disk_policy.hpp"

#include "daemon/store/archive_thread.hpp"
#include "daemon/store/journal_thread.hpp"
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::daemon::store;
using a351::daemon::status::Status;
using namespace std::chrono_literals;

namespace {

constexpr std::uint64_t kGiB = std::uint64_t{1} << 30;

}  // namespace

TEST_CASE("the journal is stuck after two failures, or in one operation of more than a minute") {
    Retry retry(1, {});
    CHECK_FALSE(is_stuck(retry, 60s));
    CHECK(is_stuck(retry, 60s + 1ms));
    const SteadyTime now(1h);
    retry.note_failure(now);
    CHECK_FALSE(is_stuck(retry, 0s));
    CHECK(retry.may_try(now));
    retry.note_failure(now);
    CHECK(is_stuck(retry, 0s));
    CHECK_FALSE(retry.may_try(now + 10s - 1ms));
    CHECK(retry.may_try(now + 10s));
    retry.note_success();
    CHECK(retry.may_try(now));
    CHECK(retry.is_recent(now + 10s - 1ms));
}

TEST_CASE("a full queue drops the oldest chunks only if the journal is stuck") {
    CHECK(overflow_of(99, 100, true) == Overflow::none);
    CHECK(overflow_of(100, 100, false) == Overflow::reader_waits);
    CHECK(overflow_of(100, 100, true) == Overflow::oldest_dropped);
}

TEST_CASE("each trouble of the disk has a level and a sentence") {
    const auto reported = [](const JournalStatus& journal, const ArchiveStatus& archive,
                             const std::string& keeper = {},
                             std::optional<std::uint64_t> free_bytes = kGiB) {
        Status status;
        status.disk_free_bytes = free_bytes;
        report(journal, archive, keeper, false, status);
        return status;
    };
    CHECK(reported({}, {}).level == Status::Level::good);
    CHECK(reported({}, {}, "x").level == Status::Level::warning);
    JournalStatus journal;
    journal.trouble = "x";
    CHECK(reported(journal, {}).level == Status::Level::fault);
    journal = {};
    journal.present_sync = 1s;
    CHECK(reported(journal, {}).level == Status::Level::warning);
    ArchiveStatus archive;
    archive.metadata_trouble = "x";
    CHECK(reported({}, archive).level == Status::Level::warning);

    CHECK(reported({}, {}, {}, kGiB - 1).level == Status::Level::warning);
    const auto sentence = [&](std::optional<std::uint64_t> free_bytes) {
        const Status status = reported({}, {}, {}, free_bytes);
        REQUIRE(status.reasons.size() == 1);
        return status.reasons.front().english();
    };
    CHECK(sentence(120'000'000).find("at most 9 days") != std::string::npos);
    CHECK(sentence(100'000'000).find("less than a day") != std::string::npos);
    CHECK(sentence({}) ==
          "disk: the free space cannot be determined; check the disk of storage.root");
    CHECK(may_create_reserve(std::nullopt, 100));
}
