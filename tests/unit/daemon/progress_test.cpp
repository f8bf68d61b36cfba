#include "daemon/store/progress.hpp"

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::daemon::store;
using a351::journal::SessionId;

namespace {

const SessionId kSession{{1}};
const SessionId kOther{{2}};

}  // namespace

TEST_CASE("a sample is journaled once its chunk is both parsed and synced") {
    Progress progress;
    progress.parsed(1, kSession, std::nullopt);
    progress.parsed(2, kSession, 9);
    CHECK(progress.indices().received == 9);
    CHECK(progress.indices().journaled == std::nullopt);
    progress.journal_synced(1);
    CHECK(progress.indices().journaled == std::nullopt);
    progress.journal_synced(3);
    CHECK(progress.indices().journaled == 9);
    progress.parsed(3, kSession, 15);
    CHECK(progress.indices().journaled == 15);
    progress.parsed(4, kSession, 20);
    CHECK(progress.indices().journaled == 15);
    CHECK(progress.indices().archived == std::nullopt);
}

TEST_CASE("indices of one session never count for another") {
    Progress progress;
    progress.parsed(1, kSession, 9);
    progress.journal_synced(1);
    progress.parsed(2, kOther, std::nullopt);
    CHECK(progress.indices().session == kOther);
    CHECK(progress.indices().received == std::nullopt);
    CHECK(progress.indices().journaled == std::nullopt);
    progress.archive_synced(kSession, 9);
    CHECK(progress.indices().archived == std::nullopt);
}

TEST_CASE("indices before a restart of the sensor's counter never count after it") {
    Progress progress;
    progress.parsed(1, kSession, 900);
    progress.journal_synced(1);
    progress.parsed(2, kSession, 950);
    progress.parsed(3, kSession, 4);
    CHECK(progress.indices().received == 4);
    CHECK(progress.indices().journaled == std::nullopt);
    progress.archive_synced(kSession, 900);
    CHECK(progress.indices().archived == std::nullopt);
    progress.journal_synced(2);
    CHECK(progress.indices().journaled == std::nullopt);
    progress.journal_synced(3);
    CHECK(progress.indices().journaled == 4);
    progress.parsed(4, kSession, 1000);
    progress.archive_synced(kSession, 950);
    CHECK(progress.indices().archived == std::nullopt);
    progress.archive_synced(kSession, 920);
    CHECK(progress.indices().archived == 920);
}
