#include "daemon/store/progress.hpp"

#include <catch2/catch.hpp>

using namespace a351::daemon;
using a351::record::SessionId;

namespace {

const SessionId kSession{{1}};
const SessionId kOther{{2}};

}  // namespace

TEST_CASE("a sample is journaled once its chunk is both parsed and synced", "[daemon][progress]") {
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

TEST_CASE("indices of one session never count for another", "[daemon][progress]") {
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

TEST_CASE("a chunk is marked once a synced mark covers its samples and all before",
          "[daemon][progress]") {
    Progress progress;
    progress.parsed(1, kSession, std::nullopt);
    for (std::uint64_t chunk = 2; chunk <= 302; ++chunk)
        progress.parsed(chunk, kSession, static_cast<std::int64_t>(chunk * 10));
    CHECK(progress.marked_chunk() == 0);
    progress.mark_synced(kSession, 1500);
    const std::uint64_t marked = progress.marked_chunk();
    CHECK(marked <= 150);
    CHECK(marked > 90);
    progress.parsed(303, kOther, 7);
    progress.mark_synced(kSession, 1400);  // says nothing new
    CHECK(progress.marked_chunk() == marked);
    progress.mark_synced(kOther, 6);
    CHECK(progress.marked_chunk() >= 252);  // of the session before
    CHECK(progress.marked_chunk() < 303);
    progress.mark_synced(kOther, 7);
    CHECK(progress.marked_chunk() == 303);
    progress.mark_synced(kSession, 9'999);
    CHECK(progress.marked_chunk() == 303);
}
