// A clock that is set back within a session: the same times occur twice, in the archive and in its
// replay.

#include <algorithm>
#include "tests/support/catch.hpp"

#include "tests/unit/archive/data_root.hpp"

using namespace a351;
using namespace a351::archive;
using namespace a351::files;
using namespace a351::journal;
using namespace std::chrono_literals;

namespace {

const UtcTime kMidnight = *parse_rfc3339("2027-01-01T00:00:00Z");
constexpr Nanoseconds kUntilStep = 100s;
constexpr int kSeconds = 240;

struct Step {
    const char* name;
    Nanoseconds back;
    bool is_announced;  ///< True: announced as a leap second. False: followed a minute later.
};

timing::ClockReading reading(Nanoseconds since_start, const Step& step) {
    const bool is_past = since_start > kUntilStep;
    const UtcTime realtime =
        kMidnight - kUntilStep + since_start - (is_past ? step.back : Nanoseconds(0));
    timing::ClockReading reading{kRawStart + since_start, since_start, realtime, true, 500, 100};
    if (step.is_announced && !is_past) reading.leap = timing::LeapSecond::inserted;
    return reading;
}

std::vector<journal::Chunk> journal_of(const Step& step) {
    journal::Header header = header_at(0s);
    header.clock = reading(0s, step);
    std::vector<journal::Chunk> chunks{header};
    for (int second = 0; second < kSeconds; ++second) {
        RxChunk rx;
        for (std::int64_t k = 50 * second; k < 50 * (second + 1); ++k) {
            const auto bytes = frame_of(values_of(k));
            rx.bytes.insert(rx.bytes.end(), bytes.begin(), bytes.end());
            rx.reads.push_back({static_cast<std::uint32_t>(rx.bytes.size()), kRawStart + due(k)});
        }
        chunks.emplace_back(std::move(rx));
        chunks.emplace_back(reading(due(50 * second + 49), step));
    }
    return chunks;
}

std::vector<std::int32_t> sorted(std::vector<std::int32_t> counts) {
    std::sort(counts.begin(), counts.end());
    return counts;
}

}  // namespace

TEST_CASE(
    "a session whose clock was set back is recovered completely and once, whenever it was killed") {
    for (const Step& step :
         {Step{"a leap second", 1s, true},
          Step{"a leap second as a host sees it", 1'000'003us, true}, Step{"an hour", 1h, false}}) {
        const auto chunks = journal_of(step);
        std::vector<std::int32_t> expected;
        for (std::int64_t k = 0; k < 50 * kSeconds; ++k)
            expected.push_back(values_of(k).axes.at(2));
        std::sort(expected.begin(), expected.end());
        for (std::size_t killed_s = 98; killed_s < kSeconds; killed_s += 4) {
            CAPTURE(step.name, killed_s);
            const DataRoot root;
            const auto rest = chunks.begin() + static_cast<std::ptrdiff_t>(1 + 2 * killed_s);
            {
                archive::Writer writer(posix_files(), root.archive(), {});
                Archiver archiver(writer);
                for (auto chunk = chunks.begin(); chunk != rest; ++chunk) archiver.take(*chunk);
                REQUIRE_NOTHROW(writer.sync());
            }
            archive::Writer writer(posix_files(), root.archive(), {});
            writer.begin_replay();
            Archiver archiver(writer);
            for (const journal::Chunk& chunk : chunks) archiver.take(chunk);
            archiver.close_records();
            REQUIRE_NOTHROW(writer.sync());
            CHECK(writer.replay_conflicts() == 0);
            CHECK(sorted(root.counts("BNZ")) == expected);
        }
    }
}
