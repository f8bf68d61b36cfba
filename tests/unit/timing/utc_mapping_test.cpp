#include "protocol/timing/utc_mapping.hpp"

#include <utility>
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::timing;
using namespace std::chrono_literals;

namespace {

const UtcTime kHostNoon = *parse_rfc3339("2026-03-01T12:00:00Z");

/// A host whose clock can be set, with one clock reading a second.
struct DriftingHost {
    UtcMapping mapping;
    Nanoseconds now{0};     ///< True time since noon.
    double offset_s = 0.0;  ///< Error of the clock, positive if it is fast.
    double slew_ppm = 0.0;
    bool is_synchronised = true;
    std::int64_t max_error_us = 1000;
    LeapSecond leap = LeapSecond::none;
    std::optional<Nanoseconds> followed;

    [[nodiscard]] RawTime raw() const { return RawTime(500s + now); }
    [[nodiscard]] UtcTime clock() const { return kHostNoon + now + from_seconds(offset_s); }

    void run(int seconds) {
        for (int i = 0; i < seconds; ++i) {
            now += 1s;
            offset_s += 1e-6 * slew_ppm;
            const auto step = mapping.observe(
                {raw(), raw().time_since_epoch(), clock(), is_synchronised, max_error_us, 0, leap});
            if (step) followed = step;
        }
    }
    /// Returns the error of the mapping against true time, ms.
    [[nodiscard]] double error_ms() const {
        return 1e3 * seconds_between(kHostNoon + now, mapping.at(raw()));
    }
};

}  // namespace

TEST_CASE("a slew of 500 ppm is followed to 1 ms") {
    DriftingHost host;
    host.run(10);
    for (const double slew_ppm : {500.0, 0.0, -500.0, 0.0}) {
        host.slew_ppm = slew_ppm;
        for (int i = 0; i < 100; ++i) {
            const UtcTime ahead = host.mapping.at(host.raw() + 1500ms);
            host.run(1);
            CHECK(host.mapping.at(host.raw()) == host.clock());
            CHECK(std::chrono::abs(ahead - (host.clock() + 500ms)) < Nanoseconds(1ms));
        }
    }
    CHECK_FALSE(host.followed);
}

TEST_CASE("a step of a host that was synchronised is doubted, then followed") {
    for (const double step_s : {3600.0, -3600.0, 0.06}) {
        DriftingHost host;
        host.run(100);
        host.offset_s = step_s;
        host.is_synchronised = false;  // as clock_settime leaves it
        host.run(300);
        CHECK(std::abs(host.error_ms()) < 1e-3);
        CHECK(host.mapping.is_held());
        CHECK_FALSE(host.mapping.is_synchronised());
        CHECK(host.mapping.error_at(host.raw()) >= Nanoseconds(1ms + 30ms));
        host.is_synchronised = true;
        host.run(59);
        CHECK_FALSE(host.followed);
        host.run(2);
        REQUIRE(host.followed);
        CHECK(*host.followed == from_seconds(step_s));
        CHECK(std::abs(host.error_ms() - 1e3 * step_s) < 1e-3);
        CHECK(host.mapping.is_synchronised());
    }
}

TEST_CASE("a clock that is set and set back changes nothing") {
    DriftingHost host;
    host.run(100);
    host.offset_s = 5.0;
    host.run(40);
    CHECK(host.mapping.is_held());
    host.offset_s = 0.0;
    host.run(200);
    CHECK_FALSE(host.followed);
    CHECK_FALSE(host.mapping.is_held());
}

TEST_CASE(
    "a step while the clock is slewed stays doubtful, and the stated error covers the true one") {
    DriftingHost host;
    host.run(10);
    host.slew_ppm = 500.0;
    host.run(10);
    host.slew_ppm = 0.0;
    host.offset_s += 1.0;
    host.is_synchronised = false;
    const double before_ms = host.error_ms();
    for (int minute = 0; minute < 60; ++minute) {
        host.run(60);
        REQUIRE(host.mapping.is_held());
        const auto stated_ms =
            1e3 * std::chrono::duration<double>(host.mapping.error_at(host.raw())).count();
        REQUIRE(std::abs(host.error_ms() - before_ms) < stated_ms);
        REQUIRE(host.error_ms() < 500.0);
    }
}

TEST_CASE("a clock that keeps jumping is not followed") {
    DriftingHost host;
    host.run(100);
    for (int i = 0; i < 10; ++i) {
        host.offset_s += 1.0;
        host.run(50);
    }
    CHECK_FALSE(host.followed);
    CHECK(std::abs(host.error_ms()) < 1e-3);
}

TEST_CASE("the first synchronisation is followed at once") {
    DriftingHost host;
    host.is_synchronised = false;
    host.offset_s = -1.7e9;  // 1970
    host.run(30);
    CHECK(host.mapping.error_at(host.raw()) >= Nanoseconds(1s));
    CHECK_FALSE(host.mapping.is_held());
    host.offset_s = 0.0;
    host.is_synchronised = true;
    host.run(1);
    REQUIRE(host.followed);
    CHECK(std::abs(host.error_ms()) < 1e-3);
    CHECK(host.mapping.error_at(host.raw()) < Nanoseconds(2ms));
}

TEST_CASE("a step of a clock that is never synchronised is followed after a minute") {
    DriftingHost host;
    host.is_synchronised = false;
    host.run(30);
    host.offset_s = 100.0;
    host.run(60);
    CHECK_FALSE(host.followed);
    host.run(1);
    CHECK(host.followed);
}

TEST_CASE("a step within a minute of waking up is doubted") {
    DriftingHost host;
    host.is_synchronised = false;
    host.run(30);
    host.mapping.woke_up();
    host.run(1);
    host.offset_s = 100.0;
    host.is_synchronised = true;
    host.run(50);
    CHECK_FALSE(host.followed);
    host.run(20);
    CHECK(host.followed);
}

TEST_CASE("an announced leap second is followed at once, with a larger stated error for minutes") {
    for (const auto& [leap, step_s] :
         {std::pair(LeapSecond::inserted, -1.0), std::pair(LeapSecond::removed, 1.0)}) {
        for (const bool is_still_announced : {false, true}) {  // by the reading after it
            DriftingHost host;
            host.leap = leap;
            host.run(12 * 3600 - 150);
            CHECK(host.mapping.error_at(host.raw()) < Nanoseconds(2ms));
            host.run(149);
            CHECK(host.mapping.error_at(host.raw()) >= Nanoseconds(1s));
            CHECK_FALSE(host.mapping.is_held());
            host.offset_s += step_s;  // at midnight
            if (!is_still_announced) host.leap = LeapSecond::none;
            host.run(1);
            REQUIRE(host.followed);
            CHECK(*host.followed == from_seconds(step_s));
            host.leap = LeapSecond::none;
            host.run(1);
            CHECK(host.mapping.at(host.raw()) == host.clock());
            CHECK(host.mapping.is_synchronised());
            CHECK(host.mapping.error_at(host.raw()) >= Nanoseconds(1s));
            host.run(130);
            CHECK(host.mapping.error_at(host.raw()) < Nanoseconds(2ms));
        }
    }
}

TEST_CASE("a step of one second at another time than the announced one is doubted") {
    DriftingHost host;
    host.leap = LeapSecond::inserted;
    host.run(100);
    host.offset_s = -1.0;
    host.run(10);
    CHECK_FALSE(host.followed);
    CHECK(host.mapping.is_held());
}
