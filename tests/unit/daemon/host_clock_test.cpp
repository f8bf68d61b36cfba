#include "daemon/source/host_clock.hpp"

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::daemon::source;

TEST_CASE("on simulated time all clocks show the simulated UTC, synchronised and without error",
          "[daemon][host_clock]") {
    const UtcTime start = *parse_rfc3339("2026-03-01T00:00:00Z");
    const UtcTime host = host_realtime();
    const HostClock clock(ClockScale{1000.0, start, host});
    const auto reading = clock.read();
    CHECK(reading.realtime >= start);
    CHECK(reading.raw.time_since_epoch() == reading.realtime.time_since_epoch());
    CHECK(reading.boottime == reading.realtime.time_since_epoch());
    CHECK(reading.is_synchronised);
    CHECK(reading.max_error_us == 0);
    CHECK(clock.raw() >= reading.raw);
    CHECK(clock.real_span(std::chrono::seconds(2)) == std::chrono::milliseconds(2));
    CHECK(clock.instrument_span(std::chrono::milliseconds(500)) == std::chrono::seconds(500));
    CHECK(clock.boot_id() == "simulated");
}

TEST_CASE("a reading of the host's clocks lies between readings before and after it",
          "[daemon][host_clock]") {
    const HostClock clock;
    const RawTime raw_before = clock.raw();
    const auto reading = clock.read();
    CHECK(reading.raw >= raw_before);
    CHECK(reading.raw <= clock.raw());
    CHECK(reading.boottime > Nanoseconds(0));
    CHECK(clock.real_span(std::chrono::seconds(2)) == std::chrono::seconds(2));
    CHECK_FALSE(clock.boot_id().empty());
}
