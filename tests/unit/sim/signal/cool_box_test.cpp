#include "sim/signal/cool_box.hpp"

#include <cmath>
#include <vector>
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::sim::scenario;
using namespace a351::sim::signal;

namespace {

Scenario day(const std::string& more) {
    return parse_scenario(
        "base = \"tsukuba\"\nname = \"x\"\n[[ambient]]\nat_h = 0\ndegc = 25\n" + more, "x.toml");
}

std::vector<double> air_degc(const Scenario& scenario, std::uint64_t seed, int seconds) {
    CoolBox box(scenario, plan_survey(scenario, seed), seed);
    std::vector<double> air;
    for (int i = 0; i < seconds; ++i) air.push_back(box.next().value());
    return air;
}

}  // namespace

TEST_CASE("with the lid closed the air keeps its listed temperature", "[sim][cool_box]") {
    for (const double degc : air_degc(day(""), 1, 3600)) CHECK(degc == 25.0);
}

TEST_CASE("with the lid open the air approaches the outside temperature, and returns afterwards",
          "[sim][cool_box]") {
    // The record starts at 20:42:12; the lid is open for 10 min, from 18 min after that.
    const Scenario scenario =
        day("[[lid_open]]\nfrom_utc = \"2017-07-15T21:00:12Z\"\nto_utc = \"2017-07-15T21:10:12Z\"\n"
            "outside_degc = 35\n");
    const auto air = air_degc(scenario, 1, 3 * 3600);
    const double open_s = 600.0;
    const std::size_t open_at = 18 * 60, closed_at = 28 * 60;
    CHECK(air[open_at] == 25.0);
    const double reached = 10.0 * (1.0 - std::exp(-open_s / scenario.cool_box.open_tau_s));
    CHECK(air[closed_at] == Approx(25.0 + reached).margin(1e-6));
    const double later_s = 900.0;
    CHECK(
        air[closed_at + 900] ==
        Approx(25.0 + reached * std::exp(-later_s / scenario.cool_box.closed_tau_s)).margin(1e-6));
}

TEST_CASE("a lid left open at a stay is open from its start to its end", "[sim][cool_box]") {
    const Scenario scenario =
        day("[schedule]\nsetups = 2\n[[lid_open]]\nsite = \"No.12\"\noutside_degc = 35\n");
    const auto plan = plan_survey(scenario, 1);
    const auto air = air_degc(scenario, 1, 5 * 3600);
    const auto second = [&](UtcTime time) {
        return static_cast<std::size_t>(seconds_between(scenario.start(), time));
    };
    REQUIRE(plan[2].site.name == "No.12");
    CHECK(air[second(plan[2].start)] == 25.0);
    for (std::size_t i = second(plan[2].start) + 2; i < second(plan[3].end); ++i) {
        REQUIRE(air[i + 1] > air[i]);
    }
    CHECK(air[second(plan[3].end) + 60] < air[second(plan[3].end) + 2]);
}

TEST_CASE("the random walk of the air grows with the square root of time", "[sim][cool_box]") {
    const Scenario scenario = day("[cool_box]\nwalk_degc_per_sqrt_h = 0.5\n");
    constexpr int kSeeds = 400;
    double hour = 0.0, four_hours = 0.0;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        const auto air = air_degc(scenario, seed, 4 * 3600 + 1);
        hour += (air[3600] - 25.0) * (air[3600] - 25.0) / kSeeds;
        four_hours += (air[4 * 3600] - 25.0) * (air[4 * 3600] - 25.0) / kSeeds;
    }
    // A variance from 400 draws is good to 7 %, one sigma.
    CHECK(hour == Approx(0.25).epsilon(0.2));
    CHECK(four_hours == Approx(1.0).epsilon(0.2));
}
