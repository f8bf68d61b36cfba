// The law of the frame counter for every pair of values: one frame after the other, with and without
// bytes lost in between.

#include <array>
#include <cstdio>
#include <numeric>

#include "protocol/timing/sample_index.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/long_tests.hpp"

using namespace a351;
using namespace a351::timing;
using namespace std::chrono_literals;
using Kind = Placement::Kind;

namespace {

constexpr int kCounts = 65536;

/// Returns the number of steps from a counter value to another `ahead` of it, counted one by one;
/// 0 if no number of steps up to a wrap leads there.
std::array<std::int64_t, kCounts> steps_to(int step) {
    std::array<std::int64_t, kCounts> steps{};
    for (std::int64_t n = kCounts / std::gcd(step, kCounts); n > 0; --n)
        steps[static_cast<std::size_t>(n * step % kCounts)] = n;
    steps[0] = 0;
    return steps;
}

/// Returns where the second of two frames belongs that arrives one period after the first.
Placement expected(int ahead, std::int64_t steps, int rate_hz, bool contiguous) {
    const auto after = [](std::int64_t index) -> Placement {
        return {index == 1 ? Kind::next : Kind::after_gap, index, index - 1};
    };
    if (ahead == 0) return {Kind::duplicate, 0, 0};
    const int step = 4000 / rate_hz;
    // Elapsed time is one sample and agrees within 1 s.
    const bool is_in_time = steps > 0 && steps - 1 <= rate_hz;
    if (!contiguous) return is_in_time ? after(steps) : Placement{Kind::new_session, 0, 0};
    // A jump without a wrap, unless it is a step back of less than 4096.
    if (steps > 0 && steps * step == ahead && ahead <= kCounts - 4096) return after(steps);
    return is_in_time ? after(steps) : Placement{Kind::anomaly, 0, 0};
}

}  // namespace

TEST_CASE("two frames are placed by the law of the counter, whatever its two values") {
    std::int64_t pairs = 0, wrong = 0;
    std::array<std::int64_t, 6> kinds{};
    for (const int rate_hz : {50, 100, 200, 500, 1000}) {
        const int step = 4000 / rate_hz;
        const auto steps = steps_to(step);
        // At the other rates every difference is tried, from 64 values.
        const int stride = !test::is_long() ? 4093 : rate_hz == 50 ? 1 : 1021;
        const RawTime start(100s), end = start + Nanoseconds(1s) / rate_hz;
        for (int first = 0; first < kCounts; first += stride) {
            SampleIndex begun(static_cast<std::uint16_t>(step), Hertz(rate_hz));
            (void)begun.place(static_cast<std::uint16_t>(first), true, start);
            for (int ahead = 0; ahead < kCounts; ++ahead) {
                const std::int64_t to = steps[static_cast<std::size_t>(ahead)];
                for (const bool contiguous : {true, false}) {
                    SampleIndex index = begun;
                    const auto found =
                        index.place(static_cast<std::uint16_t>(first + ahead), contiguous, end);
                    const auto due = expected(ahead, to, rate_hz, contiguous);
                    ++pairs;
                    ++kinds[static_cast<std::size_t>(due.kind)];
                    const bool is_right = found.kind == due.kind && found.index == due.index &&
                                          found.missing == due.missing;
                    wrong += is_right ? 0 : 1;
                    if (!is_right && wrong <= 3)
                        std::printf("%d Hz, %d to %d: kind %d, not %d\n", rate_hz, first,
                                    (first + ahead) % kCounts, static_cast<int>(found.kind),
                                    static_cast<int>(due.kind));
                }
            }
        }
    }
    std::printf(
        "%lld pairs: %lld next, %lld gaps, %lld duplicates, %lld anomalies, %lld sessions\n",
        static_cast<long long>(pairs), static_cast<long long>(kinds[1]),
        static_cast<long long>(kinds[2]), static_cast<long long>(kinds[3]),
        static_cast<long long>(kinds[4]), static_cast<long long>(kinds[5]));
    CHECK(wrong == 0);
}
