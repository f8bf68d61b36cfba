// Battery and clocks of the host.

#include "daemon/source/battery.hpp"
#include "daemon/source/host_clock.hpp"
#include "daemon/status/status.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::source;

namespace {

void write_battery(const test::TemporaryDirectory& supplies, const std::string& name, int percent,
                   const std::string& state) {
    supplies.write(name + "/type", "Battery\n");
    supplies.write(name + "/capacity", std::to_string(percent) + '\n');
    supplies.write(name + "/status", state + '\n');
}

status::Status assessed(std::optional<source::Battery> battery) {
    status::Status status;
    status.timing_state = timing::State::locked;
    status.is_host_synchronised = true;
    status.battery = battery;
    status::assess(status);
    return status;
}

}  // namespace

TEST_CASE("the charge is the mean of the computer's batteries") {
    const test::TemporaryDirectory supplies;
    CHECK_FALSE(source::read_battery(supplies.path() / "absent"));
    supplies.write("AC/type", "Mains\n");
    write_battery(supplies, "mouse", 3, "Discharging");
    supplies.write("mouse/scope", "Device\n");
    supplies.write("BAT9/type", "Battery\n");  // Without a charge: an empty slot.
    CHECK_FALSE(source::read_battery(supplies.path()));

    write_battery(supplies, "BAT0", 80, "Not charging");
    const auto one = source::read_battery(supplies.path());
    REQUIRE(one);
    CHECK(one->percent == 80.0);
    CHECK_FALSE(one->is_discharging);

    write_battery(supplies, "BAT1", 40, "Discharging");
    const auto two = source::read_battery(supplies.path());
    REQUIRE(two);
    CHECK(two->percent == 60.0);
    CHECK(two->is_discharging);
}

TEST_CASE("a battery that discharges is a warning from 15 % on") {
    using source::Battery;
    using Level = status::Status::Level;
    CHECK(assessed({}).level == Level::good);
    CHECK(assessed(Battery{16.0, true}).level == Level::good);
    CHECK(assessed(Battery{5.0, false}).level == Level::good);
    const status::Status low = assessed(Battery{15.0, true});
    CHECK(low.level == Level::warning);
    REQUIRE(low.reasons.size() == 1);
    CHECK(low.reasons[0].english().find("battery") != std::string::npos);
}

TEST_CASE("on simulated time all clocks show the simulated UTC, synchronised and without error") {
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

TEST_CASE("a reading of the host's clocks lies between readings before and after it") {
    const HostClock clock;
    const RawTime raw_before = clock.raw();
    const auto reading = clock.read();
    CHECK(reading.raw >= raw_before);
    CHECK(reading.raw <= clock.raw());
    CHECK(reading.boottime > Nanoseconds(0));
    CHECK(clock.real_span(std::chrono::seconds(2)) == std::chrono::seconds(2));
    CHECK_FALSE(clock.boot_id().empty());
}
