#include "daemon/source/battery.hpp"

#include "tests/support/catch.hpp"

#include "daemon/status/status.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::daemon;

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

TEST_CASE("the charge is the mean of the computer's batteries", "[daemon][battery]") {
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

TEST_CASE("a battery that discharges is a warning from 15 % on", "[daemon][battery]") {
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
