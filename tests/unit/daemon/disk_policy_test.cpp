#include "daemon/store/disk_policy.hpp"

#include "daemon/store/archive_thread.hpp"
#include "daemon/store/journal_thread.hpp"
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::daemon::store;
using a351::daemon::status::Status;
using namespace std::chrono_literals;

TEST_CASE("a reserve is made although the free space is unknown", "[daemon][disk]") {
    CHECK(may_create_reserve(std::nullopt, 100));
}

TEST_CASE("the journal is stuck after two failures, or in one operation of more than a minute",
          "[daemon][disk]") {
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

TEST_CASE("a full queue drops the oldest chunks only if the journal is stuck", "[daemon][disk]") {
    CHECK(overflow_of(99, 100, true) == Overflow::none);
    CHECK(overflow_of(100, 100, false) == Overflow::reader_waits);
    CHECK(overflow_of(100, 100, true) == Overflow::oldest_dropped);
}

TEST_CASE("each trouble of the disk has a level and a sentence", "[daemon][disk]") {
    const auto reported = [](const JournalStatus& journal, const ArchiveStatus& archive,
                             const std::string& keeper, bool is_short) {
        Status status;
        status.disk_free_bytes = std::uint64_t{1} << 40;
        report(journal, archive, keeper, is_short, status);
        return status;
    };
    CHECK(reported({}, {}, {}, false).level == Status::Level::good);
    CHECK(reported({}, {}, "x", false).level == Status::Level::warning);
    JournalStatus journal;
    journal.trouble = "x";
    CHECK(reported(journal, {}, {}, false).level == Status::Level::fault);
    journal = {};
    journal.present_sync = 1s;
    CHECK(reported(journal, {}, {}, false).level == Status::Level::warning);
    ArchiveStatus archive;
    archive.metadata_trouble = "x";
    CHECK(reported({}, archive, {}, false).level == Status::Level::warning);
}

TEST_CASE("below 1 GiB of free space, or if it is unknown, the status warns", "[daemon][disk]") {
    const auto reported = [](std::optional<std::uint64_t> free_bytes) {
        Status status;
        status.disk_free_bytes = free_bytes;
        report({}, {}, {}, false, status);
        return status;
    };
    constexpr std::uint64_t kGiB = std::uint64_t{1} << 30;
    CHECK(reported(kGiB).level == Status::Level::good);
    CHECK(reported(kGiB - 1).level == Status::Level::warning);
    const auto sentence = [&](std::uint64_t free_bytes) {
        const Status status = reported(free_bytes);
        REQUIRE(status.reasons.size() == 1);
        return status.reasons.front().english();
    };
    CHECK(sentence(120'000'000).find("at most 9 days") != std::string::npos);
    CHECK(sentence(100'000'000).find("less than a day") != std::string::npos);
    CHECK(reported({}).reasons ==
          std::vector<text::Message>{"disk: the free space cannot be determined; check the disk of "
                                     "storage.root"});
}
