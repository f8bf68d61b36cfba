// Every difference between two samples through the coding of records, as Steim-2 or integers.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <span>
#include <vector>

#include "protocol/archive/miniseed.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/long_tests.hpp"

namespace a351::archive {
namespace {

using Samples = std::vector<std::int32_t>;

/// Returns true if the samples come back from the records into which they are packed.  A record
/// begins with the last sample of the one before, so that each difference is within a record.
bool come_back(std::span<const std::int32_t> samples) {
    RecordHeader header;
    header.network = "XX";
    header.station = "A351";
    header.location = "00";
    header.channel = "BNZ";
    header.start = *parse_rfc3339("2026-03-01T12:00:00Z");
    header.nominal_rate = Hertz(50);
    while (true) {
        const PackedRecord record = pack_record(header, samples);
        const auto decoded = decode_record(record.bytes);
        if (!decoded || decoded->samples.size() != record.sample_count ||
            !std::ranges::equal(decoded->samples, samples.first(record.sample_count)))
            return false;
        if (record.sample_count == samples.size()) return true;
        samples = samples.subspan(std::max<std::size_t>(record.sample_count - 1, 1));
    }
}

/// Returns samples with the differences low, -(low + 1), low + 2 ... -high, or their opposites.
/// Their signs alternate, so that the samples stay small.
Samples alternating(std::int64_t low, std::int64_t high, std::int64_t sign) {
    std::int64_t value = -sign * low / 2;
    Samples samples{static_cast<std::int32_t>(value)};
    for (std::int64_t size = low; size <= high; ++size, sign = -sign)
        samples.push_back(static_cast<std::int32_t>(value += sign * size));
    return samples;
}

/// Tries all differences of these sizes, of both signs.  Returns the number of them.
std::int64_t try_sizes(std::int64_t low, std::int64_t high) {
    constexpr std::int64_t kAtOnce = 50'000;
    std::int64_t tried = 0;
    for (std::int64_t from = low; from <= high; from += kAtOnce) {
        const std::int64_t to = std::min(from + kAtOnce - 1, high);
        for (const int sign : {1, -1}) REQUIRE(come_back(alternating(from, to, sign)));
        tried += 2 * (to - from + 1);
    }
    return tried;
}

}  // namespace

TEST_CASE("a difference of any size up to 2^30 and of either sign comes back unchanged") {
    constexpr std::int64_t kQuarter = std::int64_t{1} << 28, kAround = 1000;
    std::int64_t tried = 0;
    if (test::is_long()) {
        tried = try_sizes(0, 4 * kQuarter);
    } else {  // those near quarters of the range and powers of two
        for (const std::int64_t end : {1, 2, 3, 4})
            tried += try_sizes(end * kQuarter - kAround,
                               std::min(end * kQuarter + kAround, 4 * kQuarter));
        for (std::int64_t power = 1; power < kQuarter; power *= 2)
            tried += try_sizes(std::max<std::int64_t>(power - kAround, 0), power + kAround);
    }
    std::printf("%lld differences\n", static_cast<long long>(tried));
}

TEST_CASE("each pair of differences at the limits of Steim-2's widths comes back, in any place") {
    Samples limits{0};
    for (const int width : {4, 5, 6, 8, 10, 15, 30, 31}) {
        const std::int32_t power = std::int32_t{1} << (width - 1);
        for (const std::int32_t size : {power - 1, power, power + 1}) {
            limits.push_back(size);
            limits.push_back(-size);
        }
    }
    int tried = 0;
    for (const std::int32_t one : limits) {
        for (const std::int32_t other : limits) {
            for (int before = 0; before < 7; ++before) {  // A word has seven differences at most.
                Samples samples(static_cast<std::size_t>(before + 1), 0);
                for (const std::int32_t difference : {one, other, 0, -1}) {
                    const std::int64_t next = std::int64_t{samples.back()} + difference;
                    if (next != static_cast<std::int32_t>(next)) samples.push_back(0);
                    samples.push_back(
                        static_cast<std::int32_t>(std::int64_t{samples.back()} + difference));
                }
                REQUIRE(come_back(samples));
                ++tried;
            }
        }
    }
    std::printf("%d pairs\n", tried);
}

}  // namespace a351::archive
