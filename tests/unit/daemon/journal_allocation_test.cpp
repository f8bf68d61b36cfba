/// @file
/// The way from the reader's queue to the synced journal must not allocate while the sensor
/// samples, because an allocator may wait for a lock or for memory that the host does not have.
/// Not steady, so not tested: a new segment each hour, an event, a fault of the disk.  A separate
/// program, because it replaces operator new.

#include <fmt/core.h>

#include "tests/support/counted_allocations.hpp"
#include "tests/unit/daemon/stepped_rig.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::store;

namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds kRound{50};  // Time between two rounds of the thread.

/// Everything between the reader's queue and the disk, one round per call.
struct JournalPath : SteppedRig {
    SpaceReserve reserve{files, root / "state" / "reserve", 0};
    ChunkQueue decoded;
    Progress progress;
    JournalThread journal{files, root, reads.capacity(), progress, reserve, options().time};
    ChunkMaker chunk_maker{clock, reads, journal, decoded, options().time};
    NumberedChunk next;
    std::vector<std::byte> frame = std::vector<std::byte>(24);
    std::int64_t frames = 0, chunks = 0;
    bool is_read = true;  ///< The queue took every frame.

    /// Records for `span` with a sensor of this rate, an oven and an archive.
    void record(seconds span, int rate_hz) {
        const int rounds = static_cast<int>(span / kRound);
        for (int round = 0; round < rounds; ++round) {
            pass(kRound);
            // Reads are not in step with rounds: one round in 16 comes late, the next has more.
            const std::int64_t due = std::int64_t{round + 1} * kRound.count() * rate_hz / 1000;
            for (; round % 16 != 7 && frames < due; ++frames)
                is_read &= reads.push(source::ReadQueue::Kind::rx, clock.raw(), frame);
            if (round % 20 == 0) {  // Each second.
                chunk_maker.post({clock.raw(), journal::OvenOutcome::answered, 1, {425, 425, 1}});
                journal.push(0, journal::ModelChunk{round, {}});
            }
            if (round % 200 == 0)
                journal.push(0, journal::MarkChunk{{}, {{"BN1", round, {}}, {"BNZ", round, {}}}});
            test::watched_thread = gettid();
            chunk_maker.step();
            while (decoded.try_pop(next)) ++chunks;
            journal.step();
            test::watched_thread = 0;
        }
        frames = 0;
    }
};

}  // namespace

TEST_CASE("chunks, journal and sync allocate no memory at a steady rate") {
    const int rate_hz = GENERATE(50, 1000, 20'000);
    JournalPath path;
    path.begin_session();
    test::allocations = 0;
    path.record(seconds(20), rate_hz);
    CHECK(test::allocations > 0);  // The first segment and the first buffers.
    const int at_start = test::allocations.exchange(0);
    const std::uint64_t written = path.journal.status().bytes_written;
    const std::int64_t chunks = std::exchange(path.chunks, 0);
    const seconds measured(rate_hz > 1000 ? 30 : 180);  // Ends before the segment is full.
    path.record(measured, rate_hz);

    const std::uint64_t bytes = path.journal.status().bytes_written - written;
    fmt::print(
        "{} Hz: {} allocations in the first 20 s ({} chunks), {} in the next {} s ({} "
        "chunks, {} bytes)\n",
        rate_hz, at_start, chunks, test::allocations.load(), measured.count(), path.chunks, bytes);
    CHECK(test::allocations == 0);
    CHECK(path.is_read);
    CHECK(path.chunks > measured / kRound);
    CHECK(bytes > static_cast<std::uint64_t>(measured.count() * rate_hz) * 24);
    CHECK(path.journal.status().faults == 0);
}
