#include "protocol/journal/stream_end.hpp"

#include "tests/support/catch.hpp"

#include "protocol/journal/journal_reader.hpp"
#include "tests/unit/archive/data_root.hpp"

using namespace a351;
using namespace a351::archive;
using namespace a351::journal;
using namespace std::chrono_literals;

namespace {

std::optional<StreamEnd> end_of(const std::vector<journal::Chunk>& chunks) {
    const DataRoot root;
    root.write_journal(chunks);
    return stream_end(journal::segment_files(root.journal()));
}

}  // namespace

TEST_CASE("the journal gives the last counter value of its newest session") {
    JournalStream stream(1);
    stream.frames(0, 1'000);
    const auto end = end_of(stream.chunks);
    REQUIRE(end);
    CHECK(end->header.session == header_at(0s, 1).session);
    CHECK(end->count == values_of(999).count);
    CHECK(end->arrival == kRawStart + due(999));

    CHECK_FALSE(stream_end({}));

    SECTION("also from an earlier segment of that session") {
        auto chunks = stream.chunks;
        chunks.emplace_back(header_at(due(1'000), 1));
        CHECK(end_of(chunks)->count == values_of(999).count);
    }
    SECTION("but not if the session has no frame yet") {
        auto chunks = stream.chunks;
        chunks.emplace_back(header_at(due(1'000), 2));
        CHECK_FALSE(end_of(chunks));
    }
    auto& header = std::get<journal::Header>(stream.chunks.front());
    SECTION("nor if its frames have no counter") {
        header.burst_ctrl &= static_cast<std::uint16_t>(~wire::kCountOut);
        CHECK_FALSE(end_of(stream.chunks));
    }
    SECTION("nor if the profile does not have its rate") {
        header.output_rate_hz = 7;
        CHECK_FALSE(end_of(stream.chunks));
    }
}
