#include "protocol/timing/sample_clock.hpp"

#include <catch2/catch.hpp>
#include <random>

using namespace a351;
using namespace a351::timing;
using namespace std::chrono_literals;

namespace {

const UtcTime kNoon = *parse_rfc3339("2026-03-01T12:00:00Z");
constexpr Nanoseconds kGroupDelay = 63'875us;

/// A device and a host, both in true time: frames and readings in order, one second at a time.
struct World {
    double device_ppm = 0.0;
    double raw_ppm = 0.0;  ///< Rate of the host's raw clock.
    int rate_hz = 50;
    bool is_synchronised = true;
    std::int64_t max_error_us = 500;
    SampleClock clock{{Hertz(50.0), kGroupDelay}};

    [[nodiscard]] UtcTime truth(std::int64_t k) const {
        return kNoon + from_seconds(static_cast<double>(k) / rate_hz * (1.0 - device_ppm * 1e-6));
    }
    [[nodiscard]] RawTime raw(UtcTime utc) const {
        return RawTime(1000s) + from_seconds(seconds_between(kNoon, utc) * (1.0 + raw_ppm * 1e-6));
    }
    void read_clock(UtcTime utc) {
        clock.observe_clock({raw(utc), 0s, utc, is_synchronised, max_error_us, 0});
    }
    void frame(std::int64_t k, Nanoseconds late) {
        const UtcTime due = truth(k) + kGroupDelay;
        if (k % rate_hz == 0) read_clock(due);
        clock.observe(k, raw(due + late));
    }
};

/// Delay of a frame behind an adapter that delivers every 16 ms, and now and then a busy host.
class Delays {
public:
    explicit Delays(std::uint64_t seed) : random_(seed) {}

    Nanoseconds operator()(UtcTime due) {
        const auto since_delivery = (due.time_since_epoch() + 7'777'777ns) % Nanoseconds(16ms);
        Nanoseconds late = 16ms - since_delivery;
        if (random_() % 500 == 0)
            late += Nanoseconds(static_cast<std::int64_t>(random_() % 900'000'000));
        return late + Nanoseconds(static_cast<std::int64_t>(random_() % 200'000));
    }

private:
    std::mt19937_64 random_;
};

}  // namespace

TEST_CASE("arrivals without noise give exact times", "[timing][sample_clock]") {
    World world;
    for (std::int64_t k = 0; k < 20'000; ++k) world.frame(k, 0s);
    for (std::int64_t k = 0; k < 20'000; k += 7)
        REQUIRE(world.clock.time_of(k)->utc == world.truth(k));
}

TEST_CASE("the line follows the rates of both oscillators", "[timing][sample_clock]") {
    for (const double device_ppm : {-10.0, 10.0}) {
        for (const double raw_ppm : {-100.0, 0.0, 100.0}) {
            World world;
            world.device_ppm = device_ppm;
            world.raw_ppm = raw_ppm;
            double worst_s = 0.0;
            for (std::int64_t k = 0; k < 180'000; ++k) {
                world.frame(k, 0s);
                const double error_s = seconds_between(world.truth(k), world.clock.time_of(k)->utc);
                worst_s = std::max(worst_s, std::abs(error_s));
            }
            CHECK(worst_s < 0.3e-3);  // one second at 110 ppm, and the pull lags by another
        }
    }
}

TEST_CASE("late arrivals change nothing while others come in time", "[timing][sample_clock]") {
    World punctual, late;
    std::mt19937_64 random(1);
    for (std::int64_t k = 0; k < 10'000; ++k) {
        punctual.frame(k, 0s);
        const bool is_late = k % 50 != 0 && random() % 2 == 0;
        late.frame(k, is_late ? Nanoseconds(random() % 3'000'000'000) : Nanoseconds(0));
    }
    for (std::int64_t k = 0; k < 10'000; ++k)
        REQUIRE(punctual.clock.time_of(k)->utc == late.clock.time_of(k)->utc);
}

TEST_CASE("an earlier arrival pulls the published line by at most 0.2 ms per second of data",
          "[timing][sample_clock]") {
    World world;
    for (std::int64_t k = 0; k < 500; ++k) world.frame(k, 50ms);
    for (std::int64_t k = 500; k < 20'000; ++k) world.frame(k, 0s);
    for (std::int64_t k = 0; k + 50 < 20'000; ++k) {
        const auto second = world.clock.time_of(k + 50)->utc - world.clock.time_of(k)->utc;
        REQUIRE(std::chrono::abs(second - Nanoseconds(1s)) <= Nanoseconds(200us));
    }
    CHECK(world.clock.time_of(499)->utc == world.truth(499) + 50ms);
    CHECK(world.clock.time_of(19'999)->utc == world.truth(19'999));
    CHECK(world.clock.time_of(600)->uncertainty >= Nanoseconds(48ms));  // still that far off
}

TEST_CASE("a published time never changes and does not depend on who asks when",
          "[timing][sample_clock]") {
    World asked, quiet;
    Delays delays(2), same(2);
    std::vector<UtcTime> when_new;
    for (std::int64_t k = 0; k < 30'000; ++k) {
        asked.frame(k, delays(asked.truth(k)));
        quiet.frame(k, same(quiet.truth(k)));
        when_new.push_back(asked.clock.time_of(k)->utc);
        (void)asked.clock.time_of(k + 5'000);
        (void)asked.clock.index_at(asked.truth(k));
    }
    for (std::int64_t k = 0; k < 30'000; ++k) {
        REQUIRE(quiet.clock.time_of(k)->utc == when_new[static_cast<std::size_t>(k)]);
        REQUIRE(asked.clock.time_of(k)->utc == when_new[static_cast<std::size_t>(k)]);
    }
}

TEST_CASE("index_at is the inverse of time_of", "[timing][sample_clock]") {
    World world;
    Delays delays(3);
    CHECK_FALSE(world.clock.index_at(kNoon));
    for (std::int64_t k = 0; k < 30'000; ++k) world.frame(k, delays(world.truth(k)));
    for (std::int64_t k = 0; k < 30'000; k += 11) {
        const UtcTime utc = world.clock.time_of(k)->utc;
        REQUIRE(world.clock.index_at(utc) == k);
        if (k > 0) REQUIRE(world.clock.index_at(utc - 1ns) == k);
    }
    CHECK_FALSE(world.clock.index_at(world.clock.time_of(0)->utc - 1ns));
    CHECK_FALSE(world.clock.index_at(world.clock.time_of(29'999)->utc + 1ns));
}

TEST_CASE("times older than 24 h of data are forgotten and newer ones kept",
          "[timing][sample_clock]") {
    World world;
    world.raw_ppm = 30.0;
    const std::int64_t day = 24 * 3600 * 50;
    for (std::int64_t k = 0; k < 2 * day; k += 25) world.frame(k, Nanoseconds(k % 100 * 1000));
    CHECK_FALSE(world.clock.index_at(world.truth(day - 100'000)));
    CHECK(world.clock.index_at(world.truth(day + 100)));
}

TEST_CASE("the stated uncertainty covers the true error behind a 16 ms adapter for an hour",
          "[timing][sample_clock]") {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        World world;
        world.device_ppm = seed % 2 == 0 ? 10.0 : -10.0;
        world.raw_ppm = static_cast<double>(seed) * 15.0 - 50.0;
        Delays delays(seed);
        double worst_s = 0.0;
        int outside = 0;
        for (std::int64_t k = 0; k < 180'000; ++k) {
            world.frame(k, delays(world.truth(k) + kGroupDelay));
            const auto time = *world.clock.time_of(k);
            const Nanoseconds error = time.utc - world.truth(k);
            if (std::chrono::abs(error) > time.uncertainty) ++outside;
            if (k > 5000)
                worst_s = std::max(worst_s, std::abs(std::chrono::duration<double>(error).count()));
        }
        INFO("seed " << seed << ", worst after 100 s " << worst_s);
        CHECK(outside == 0);
        CHECK(world.clock.uncertainty() < Nanoseconds(20ms));
    }
}

TEST_CASE("an unsynchronised host is not trusted to a second", "[timing][sample_clock]") {
    World world;
    world.is_synchronised = false;
    for (std::int64_t k = 0; k < 5000; ++k) world.frame(k, 0s);
    CHECK(world.clock.uncertainty() >= Nanoseconds(1s));
    World worse;
    worse.is_synchronised = false;
    worse.max_error_us = 16'000'000;  // where the kernel stops counting
    for (std::int64_t k = 0; k < 5000; ++k) worse.frame(k, 0s);
    CHECK(worse.clock.uncertainty() >= Nanoseconds(16s));
}

TEST_CASE("the clock is unlocked for 60 s of data, then coarse", "[timing][sample_clock]") {
    World world;
    CHECK_FALSE(world.clock.time_of(0));
    for (std::int64_t k = 0; k < 3000; ++k) world.frame(k, 0s);
    CHECK(world.clock.state() == TimingState::unlocked);
    world.frame(3000, 0s);
    CHECK(world.clock.state() == TimingState::coarse);
}
