#include "sim/signal/sensor_clock.hpp"

#include <cmath>
#include "tests/support/catch.hpp"

#include "sim/signal/signal_source.hpp"

using namespace a351::sim;
using namespace a351;
using namespace a351::sim::scenario;
using namespace a351::sim::signal;

namespace {

const UtcTime kStart = *parse_rfc3339("2017-07-16T00:00:00Z");
constexpr DegC kReference{42.5};

/// Returns the true time from the start to the begin of second n, in s, at a constant temperature.
double seconds_at(SensorClock clock, int n, DegC temperature) {
    for (int i = 0; i <= n; ++i) clock.begin_second(temperature);
    return seconds_between(kStart, clock.at(0.0));
}

}  // namespace

TEST_CASE("a true clock counts true seconds", "[sim][sensor_clock]") {
    SensorClock clock({}, kReference, kStart, 1);
    for (int i = 0; i < 100'000; ++i) clock.begin_second(DegC(30.0));
    CHECK(clock.at(0.0) == kStart + std::chrono::seconds(99'999));
    CHECK(clock.at(0.5) == kStart + std::chrono::milliseconds(99'999'500));
}

TEST_CASE("a fast clock counts more seconds than pass", "[sim][sensor_clock]") {
    ClockParameters parameters;
    parameters.error_ppm = 100.0;
    const SensorClock clock(parameters, kReference, kStart, 1);
    CHECK(seconds_at(clock, 36'000, kReference) == Approx(36'000.0 / 1.0001).epsilon(1e-12));
}

TEST_CASE("the clock rate follows the difference of the temperature from its reference",
          "[sim][sensor_clock]") {
    ClockParameters parameters;
    parameters.temperature_ppm_per_degc = -2.0;
    const SensorClock clock(parameters, kReference, kStart, 1);
    CHECK(seconds_at(clock, 10'000, kReference) == Approx(10'000.0).epsilon(1e-12));
    CHECK(seconds_at(clock, 10'000, DegC(43.0)) == Approx(10'000.0 / (1.0 - 1e-6)).epsilon(1e-12));
}

TEST_CASE("the clock rate wanders with the square root of time", "[sim][sensor_clock]") {
    ClockParameters parameters;
    parameters.wander_ppm_per_sqrt_h = 3.0;
    constexpr int kSeeds = 300;
    double square = 0.0;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        const SensorClock clock(parameters, kReference, kStart, seed);
        const double late_s = seconds_at(clock, 3600, kReference) - 3600.0;
        square += late_s * late_s / kSeeds;
    }
    // The integral of a random walk: variance rate^2 t^3 / 3, after an hour (3e-6)^2 / 3 h^2.
    const double expected_s2 = 9e-12 / 3.0 * 3600.0 * 3600.0;
    CHECK(square == Approx(expected_s2).epsilon(0.25));
}

TEST_CASE("the clock changes the times of the samples and not their values",
          "[sim][sensor_clock]") {
    const Scenario truth = load_scenario("tsukuba");
    const Scenario fast = parse_scenario(
        "base = \"tsukuba\"\nname = \"x\"\n[clock]\nerror_ppm = 50\n"
        "wander_ppm_per_sqrt_h = 0.1\ntemperature_ppm_per_degc = 0.5\n",
        "x.toml");
    const wire::DeviceProfile& profile = *wire::find_profile("A351");
    signal::Source steady(truth, profile, 2), moved(fast, profile, 2);
    UtcTime before = truth.start() - std::chrono::milliseconds(20);
    for (int i = 0; i < 50 * 1000; ++i) {
        const TimedSample expected = steady.next(), sample = moved.next();
        REQUIRE(sample.values == expected.values);
        REQUIRE(sample.index == expected.index);
        // Evenly spaced except for rounding to 1 ns: 20 ms less 50 ppm, which is 1 us.
        REQUIRE(std::abs(seconds_between(before, sample.instant) - 0.02) < 1.1e-6);
        before = sample.instant;
    }
    CHECK(seconds_between(truth.start(), before) == Approx(999.98 * (1.0 - 50e-6)).epsilon(2e-6));
}
