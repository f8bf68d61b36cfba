// A sensor behind the 1 ms timer of an adapter, with no polling behind it.  The emulator shares nothing with TransportWorld:
// it counts whole nanoseconds, and the bytes of a frame pass a serial line before the timer holds them.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <vector>
#include "tests/support/catch.hpp"

#include "protocol/timing/sample_clock.hpp"
#include "tests/support/long_tests.hpp"

using namespace a351;
using namespace a351::timing;

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kFrame_ns = 24 * 10 * kSecond_ns / 460'800;  // 24 bytes of 10 bits
constexpr int kRate = 50, kMinutes = 30, kWander_s = 600;
constexpr double kWander_ppm = 0.3, kMostTimer_ppm = 30.0;
constexpr double kInStep_ppm =
    3.0;  // Nearer to the sensor, the timer's phase stands still for minutes.
constexpr std::uint64_t kFirstSeed = 90001;  // Not used in development.

struct Errors {
    std::vector<double> late_ms;  ///< |error| after 10 min.
    std::size_t covered = 0, all = 0;
};

/// Adds the errors of half an hour, each when a record with the sample is packed, 8 s later.
void run(double sensor_ppm, double timer_ppm, std::uint64_t seed, Errors& errors) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> share;
    const double tick_ns = 1e6 * (1.0 - 1e-6 * timer_ppm), phase_ns = share(random) * tick_ns;
    const double wander = share(random);
    const UtcTime start = *parse_rfc3339("2026-03-01T00:00:00Z");
    SampleClock clock({Hertz(kRate), Nanoseconds(kFrame_ns)});
    std::vector<std::int64_t> taken_ns;
    double now_ns = 0.0;
    std::int64_t read_s = 0;
    for (std::int64_t k = 0; k < kMinutes * 60 * kRate; ++k) {
        taken_ns.push_back(std::llround(now_ns));
        const double sent_ns = now_ns + static_cast<double>(kFrame_ns);
        const auto arrives_ns =
            std::llround(std::ceil((sent_ns - phase_ns) / tick_ns) * tick_ns + phase_ns);
        for (; read_s * kSecond_ns <= arrives_ns; ++read_s) {
            ClockReading reading;
            reading.raw = RawTime(Nanoseconds(read_s * kSecond_ns));
            reading.boottime = reading.raw.time_since_epoch();
            reading.realtime = start + Nanoseconds(read_s * kSecond_ns);
            reading.is_synchronised = true;
            clock.observe_clock(reading);
        }
        clock.observe(k, RawTime(Nanoseconds(arrives_ns)));
        const double turns = now_ns / (1e9 * kWander_s) + wander;
        const double ppm = sensor_ppm + kWander_ppm * std::sin(2.0 * std::numbers::pi * turns);
        now_ns += 1e9 / kRate * (1.0 - 1e-6 * ppm);
        if (k % (8 * kRate) != 0 || k == 0) continue;
        const auto packed = static_cast<std::size_t>(k - 8 * kRate);
        const SampleTime time = *clock.time_of(k - 8 * kRate);
        const auto error = std::chrono::abs((time.utc - start) - Nanoseconds(taken_ns[packed]));
        ++errors.all;
        if (error <= time.uncertainty) ++errors.covered;
        if (taken_ns[packed] > 600 * kSecond_ns)
            errors.late_ms.push_back(1e-6 * static_cast<double>(error.count()));
    }
}

/// Returns the errors of sensors that are 12, 5 and -8 ppm off.
/// @param is_in_step  the timer runs within kInStep_ppm of the sensor, or farther from it.
Errors errors_of(bool is_in_step) {
    Errors errors;
    std::mt19937_64 random(kFirstSeed);
    std::uniform_real_distribution<double> any(-kMostTimer_ppm, kMostTimer_ppm),
        near(-kInStep_ppm, kInStep_ppm);
    for (std::uint64_t seed = kFirstSeed; seed < kFirstSeed + (test::is_long() ? 20 : 5); ++seed)
        for (const double sensor_ppm : {12.0, 5.0, -8.0}) {
            double timer_ppm = sensor_ppm + near(random);
            while (!is_in_step && std::abs(timer_ppm - sensor_ppm) < kInStep_ppm)
                timer_ppm = any(random);
            run(sensor_ppm, timer_ppm, seed, errors);
        }
    std::ranges::sort(errors.late_ms);
    return errors;
}

double p99(const Errors& errors) { return errors.late_ms[errors.late_ms.size() * 99 / 100]; }

}  // namespace

TEST_CASE(
    "behind a pure 1 ms timer times are right within 0.3 ms, and within 1.1 ms if it is in step") {
    for (const auto& [is_in_step, most_ms] : {std::pair(false, 0.3), std::pair(true, 1.1)}) {
        const Errors errors = errors_of(is_in_step);
        const double covered =
            static_cast<double>(errors.covered) / static_cast<double>(errors.all);
        std::printf("pure 1 ms timer%s: p99 %.2f, max %.2f ms after 600 s; covers %.1f %%\n",
                    is_in_step ? " in step" : "", p99(errors), errors.late_ms.back(),
                    100.0 * covered);
        CHECK(p99(errors) <= most_ms);
        CHECK(covered >= 0.95);
    }
}
