// The clock on simulated days: its true errors, compared with its stated uncertainty.

#include <array>
#include <cstdio>
#include <future>
#include <vector>
#include "tests/support/catch.hpp"

#include "protocol/timing/hindsight.hpp"
#include "tests/support/long_tests.hpp"
#include "tests/unit/timing/transport_world.hpp"

using namespace a351;
using namespace a351::timing;

namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
const std::uint64_t kSeeds = 3, kFewerSeeds = 3;
constexpr int kHours = 1;
#else
const std::uint64_t kSeeds = test::is_long() ? 40 : 4, kFewerSeeds = test::is_long() ? 8 : 2;
constexpr int kHours = 4;
#endif

// Seeds up to 1040, and 40 each from 20001, 30001 and 50001, were used while the estimator was
// developed; these were not.
constexpr std::uint64_t kFirstSeed = 62001;

const UtcTime kStart = *parse_rfc3339("2026-03-01T00:00:00Z");

// Group delay and wire time; they are known and subtracted, so that any value will do.
constexpr Nanoseconds kFixedDelay = std::chrono::microseconds(64'800);

/// Error and stated uncertainty of a record when it is packed, 8 s after its first sample.
struct Sighting {
    double at_s;  ///< Time since the start.
    double error_ms;
    double uncertainty_ms;
};

ClockReading reading_at(double true_s) {
    ClockReading reading;
    reading.raw = TransportWorld::raw(true_s);
    reading.boottime = reading.raw.time_since_epoch();
    reading.realtime = kStart + from_seconds(true_s);
    reading.is_synchronised = true;
    return reading;
}

constexpr std::int64_t kSamples = std::int64_t{kHours} * 3600 * TransportWorld::kRate;
constexpr std::int64_t kPackedAfter = 8 * TransportWorld::kRate;

double fixed_s() { return std::chrono::duration<double>(kFixedDelay).count(); }

Sighting sighting(double truth_s, UtcTime utc, Nanoseconds uncertainty) {
    return {truth_s, 1e3 * (seconds_between(kStart, utc) - truth_s),
            1e3 * std::chrono::duration<double>(uncertainty).count()};
}

std::vector<Sighting> live(const TransportCase& scenario, std::uint64_t seed) {
    TransportWorld world(scenario, seed);
    SampleClock clock({Hertz(TransportWorld::kRate), kFixedDelay});
    std::vector<Sighting> sightings;
    std::array<double, kPackedAfter + 1> taken_s{};
    std::int64_t seconds_read = 0;
    for (std::int64_t k = 0; k < kSamples; ++k) {
        const auto frame = world.next();
        taken_s[static_cast<std::size_t>(k) % taken_s.size()] = frame.taken_s;
        const double arrives_s = frame.arrives_s + fixed_s();
        for (; static_cast<double>(seconds_read) <= arrives_s; ++seconds_read)
            clock.observe_clock(reading_at(static_cast<double>(seconds_read)));
        clock.observe(k, TransportWorld::raw(arrives_s));
        if (k % kPackedAfter != 0 || k == 0) continue;
        const std::int64_t first = k - kPackedAfter;
        const SampleTime time = *clock.time_of(first);
        sightings.push_back(sighting(taken_s[static_cast<std::size_t>(first) % taken_s.size()],
                                     time.utc, time.uncertainty));
    }
    return sightings;
}

/// Returns the sightings of the same days after they are over.
std::vector<Sighting> in_hindsight(const TransportCase& scenario, std::uint64_t seed) {
    TransportWorld world(scenario, seed);
    UtcHistory history;
    Hindsight hindsight({Hertz(TransportWorld::kRate), kFixedDelay}, 0);
    std::vector<double> taken_s;  // one per second
    for (std::int64_t k = 0; k < kSamples; ++k) {
        const auto frame = world.next();
        hindsight.observe(k, TransportWorld::raw(frame.arrives_s + fixed_s()));
        if (k % TransportWorld::kRate != 0) continue;
        taken_s.push_back(frame.taken_s);
        history.observe(reading_at(frame.arrives_s));
    }
    std::vector<Sighting> sightings;
    for (const TimePiece& piece : hindsight.times(history)) {
        const auto second = static_cast<std::size_t>(piece.first / TransportWorld::kRate);
        sightings.push_back(sighting(taken_s[second], piece.time, piece.uncertainty));
    }
    return sightings;
}

double quantile(std::vector<double> values, double share) {
    const auto nth = values.begin() +
                     static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), nth, values.end());
    return *nth;
}

struct Score {
    std::vector<double> early, late;  ///< |error| from 100 to 300 s, and after 600 s; ms.
    std::vector<double> stated;       ///< Stated uncertainty, ms.
    double worst_after_60_s = 0.0;
    double covered = 0.0;
};

using Run = std::vector<Sighting> (*)(const TransportCase&, std::uint64_t);

Score score(const TransportCase& scenario, Run run, std::uint64_t seeds) {
    Score score;
    std::size_t count = 0, covered = 0;
    const auto take = [&](const std::vector<Sighting>& sightings) {
        for (const Sighting& s : sightings) {
            const double error = std::abs(s.error_ms);
            ++count;
            if (error <= s.uncertainty_ms) ++covered;
            if (s.at_s > 60.0) score.worst_after_60_s = std::max(score.worst_after_60_s, error);
            if (s.at_s > 100.0 && s.at_s < 300.0) score.early.push_back(error);
            if (s.at_s > 600.0) score.late.push_back(error);
            score.stated.push_back(s.uncertainty_ms);
        }
    };
    for (std::uint64_t seed = 0; seed < seeds; seed += 2) {
        auto other =
            std::async(std::launch::async, run, std::cref(scenario), kFirstSeed + seed + 1);
        take(run(scenario, kFirstSeed + seed));
        take(other.get());
    }
    score.covered = static_cast<double>(covered) / static_cast<double>(count);
    std::printf(
        "%-28s p50 %.2f p99 %.2f max %.2f ms after 600 s; p99 %.2f from 100 s; max %.2f after 60 s;"
        " stated p50 %.2f p99 %.2f; covers %.1f %%\n",
        scenario.name, quantile(score.late, 0.5), quantile(score.late, 0.99),
        quantile(score.late, 1.0), quantile(score.early, 0.99), score.worst_after_60_s,
        quantile(score.stated, 0.5), quantile(score.stated, 0.99), 100.0 * score.covered);
    return score;
}

}  // namespace

TEST_CASE("times behind a timer are as right as stated, and their uncertainty covers the error") {
    constexpr double kAny = 1e9;
    struct Case {
        TransportCase transport;
        double late_ms, early_ms;  ///< Limits of p99 after 600 s and from 100 s.
        double after_60_s_ms;      ///< Limit of all.
        std::uint64_t seeds = kSeeds;
        Run run = live;
    };
    const std::uint64_t few = kFewerSeeds;
    const std::vector<Case> cases{
        {{"16 ms timer", 16, 30, false, 0.05, 1e-3, 1, 0, 0.1}, 1.0, kAny, 4.5},
        {{"16 ms, busy host", 16, 30, false, 1.0, 1e-2, 10, 0, 0.1}, 1.0, kAny, 4.5},
        {{"16 ms, 1 ppm transient", 16, 30, false, 0.05, 1e-3, 1, 1, 0.1}, 1.0, kAny, 4.5},
        // In step with the sensor: half the spacing plus half the polling interval is hidden.
        {{"16 ms in step", 16, 0, true, 0.05, 1e-3, 1, 0, 0.0}, 2.5, kAny, 4.5},
        {{"16 ms, 0.3 ppm from step", 16, 0.3, true, 0.05, 1e-3, 1, 0, 0.0}, 2.5, kAny, 4.5, few},
        {{"16 ms, 3 ppm from step", 16, 3, true, 0.05, 1e-3, 1, 0, 0.0}, 2.5, kAny, 4.5, few},
        {{"1 ms in step", 1, 0, true, 0.05, 1e-3, 1, 0, 0.0}, 2.5, kAny, 4.5, few},
        {{"1 ms timer", 1, 30, false, 0.05, 1e-3, 1, 0, 0.1}, 0.3, 1.0, kAny},
        {{"1 ms, busy host", 1, 30, false, 1.0, 1e-2, 10, 0, 0.1}, 0.3, 1.0, kAny, few},
        {{"no adapter", 0, 0, false, 0.05, 1e-3, 1, 0, 0.1, 0}, 0.3, 1.0, kAny, few},
        // A 1 ms timer alone has to show itself.  Before, half of the error that timer and polling
        // together can hide, and the slack of 0.1 ms.
        {{"no polling, busy host", 1, 30, false, 1.0, 1e-2, 10, 0, 0.1, 0}, 0.3, 1.1, kAny},
        {{"bus frames of 1 ms", 0, 0, false, 0.05, 1e-3, 1, 0, 0.1}, 0.3, 1.1, kAny, few},
        {{"re-timed", 16, 30, false, 0.05, 1e-3, 1, 0, 0.1}, 0.5, 0.5, kAny, kSeeds, in_hindsight}};
    for (const auto& [transport, late_ms, early_ms, after_60_s_ms, seeds, run] : cases) {
        const Score result = score(transport, run, seeds);
        INFO(transport.name);
        CHECK(quantile(result.late, 0.99) <= late_ms);
        CHECK(quantile(result.early, 0.99) <= early_ms);
        CHECK(result.worst_after_60_s <= after_60_s_ms);
        CHECK(result.covered >= 0.95);
    }
}
