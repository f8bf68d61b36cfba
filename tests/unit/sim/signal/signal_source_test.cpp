#include "sim/signal/signal_source.hpp"

#include <array>
#include <cmath>
#include <limits>
#include "tests/support/catch.hpp"

#include "protocol/text/csv.hpp"
#include "sim/signal/earth_tide.hpp"
#include "sim/signal/sensor_clock.hpp"
#include "tests/unit/sim/made_up_scenario.hpp"

using namespace a351::sim;
using namespace a351;
using namespace a351::sim::scenario;
using namespace a351::sim::signal;

namespace {

const wire::DeviceProfile& a351_profile() { return *wire::find_profile("A351"); }

const UtcTime kClockStart = *parse_rfc3339("2017-07-16T00:00:00Z");
constexpr DegC kReference{42.5};

/// Returns the true time from the start to the begin of second n, in s, at a constant temperature.
double seconds_at(SensorClock clock, int n, DegC temperature) {
    for (int i = 0; i <= n; ++i) clock.begin_second(temperature);
    return seconds_between(kClockStart, clock.at(0.0));
}

}  // namespace

TEST_CASE("the same seed gives the same samples, another seed others") {
    const Scenario scenario = load_scenario("tsukuba");
    signal::Source first(scenario, a351_profile(), 5), again(scenario, a351_profile(), 5),
        other(scenario, a351_profile(), 6);
    int equal = 0;
    for (int i = 0; i < 20'000; ++i) {
        const SensorSample sample = first.next().values;
        REQUIRE(sample == again.next().values);
        equal += sample == other.next().values ? 1 : 0;
    }
    CHECK(equal == 0);
}

TEST_CASE("samples lie on a grid of 20 ms from the scenario's start") {
    const Scenario scenario = load_scenario("tsukuba");
    signal::Source source(scenario, a351_profile(), 1);
    CHECK(source.next().instant == scenario.start());
    CHECK(*source.next_instant() - scenario.start() == std::chrono::milliseconds(20));
    CHECK(static_cast<double>(source.sample_count()) / 50.0 / 3600.0 == Approx(13.2).margin(0.01));
}

TEST_CASE("a spike is on one axis, of either sign, and within the range of the scenario") {
    const Scenario calm = load_scenario("ideal");
    const Scenario struck =
        changed("ideal", "[vibration]\nspike_probability = 1.0\nspike_gal = [0.1, 1.0]\n");
    signal::Source expected(calm, a351_profile(), 1), spiked(struck, a351_profile(), 1);
    std::array<std::array<int, 2>, 3> seen{};
    for (int i = 0; i < 600; ++i) {
        const SensorSample without = expected.next().values, sample = spiked.next().values;
        int hit = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int32_t counts = sample.axes_counts[axis] - without.axes_counts[axis];
            if (counts == 0) continue;
            const double mgal = std::abs(to_milligal(a351_profile().acceleration(counts)).value());
            CHECK(mgal == Approx(550.0).margin(450.1));  // With half a count.
            ++seen[axis][counts > 0 ? 1 : 0];
            ++hit;
        }
        REQUIRE(hit == 1);
    }
    for (const auto& [down, up] : seen) {  // 100 each, less five sigma.
        CHECK(down > 53);
        CHECK(up > 53);
    }
}

TEST_CASE("counts are limited to the range of their type") {
    CHECK(to_counts(2.5) == 3);
    CHECK(to_counts(-2.5) == -2);
    CHECK(to_counts(1e12) == std::numeric_limits<std::int32_t>::max());
    CHECK(to_counts(-1e12) == std::numeric_limits<std::int32_t>::min());
    CHECK(to_counts(std::numeric_limits<double>::infinity()) ==
          std::numeric_limits<std::int32_t>::max());
    CHECK(to_counts(std::nan("")) == std::numeric_limits<std::int32_t>::min());
}

TEST_CASE("the bias of axis z stays on it when the box is turned") {
    const Scenario scenario =
        changed("ideal", "[schedule]\nlead_in_h = 0.1\njitter_s = 0\n[sensor]\nwhite_mgal = 0.0\n" +
                             stay("No.1", "00:00:00", "about_y_deg = [30]\nabout_x_deg = [0]\n"));
    signal::Source source(scenario, a351_profile(), 1);
    const SensorSample sample = source.next().values;
    const auto mgal = [](std::int32_t counts) {
        return to_milligal(a351_profile().acceleration(counts)).value();
    };
    const double gravity_mgal = scenario.sites[1].gravity->value();
    // Half a count of 0.058 mGal, and a tide of at most 0.3 mGal.
    CHECK(mgal(sample.axes_counts[0]) == Approx(0.5 * gravity_mgal).margin(0.2));
    CHECK(mgal(sample.axes_counts[2]) ==
          Approx(std::sqrt(0.75) * gravity_mgal + scenario.sensor.bias_mgal).margin(0.33));
}

TEST_CASE("the clock counts true seconds except for its error, which may depend on temperature") {
    SensorClock clock({}, kReference, kClockStart, 1);
    for (int i = 0; i < 100'000; ++i) clock.begin_second(DegC(30.0));
    CHECK(clock.at(0.0) == kClockStart + std::chrono::seconds(99'999));
    CHECK(clock.at(0.5) == kClockStart + std::chrono::milliseconds(99'999'500));
    ClockParameters fast;
    fast.error_ppm = 100.0;
    CHECK(seconds_at(SensorClock(fast, kReference, kClockStart, 1), 36'000, kReference) ==
          Approx(36'000.0 / 1.0001).epsilon(1e-12));
    ClockParameters warm;
    warm.temperature_ppm_per_degc = -2.0;
    const SensorClock rated(warm, kReference, kClockStart, 1);
    CHECK(seconds_at(rated, 10'000, kReference) == Approx(10'000.0).epsilon(1e-12));
    CHECK(seconds_at(rated, 10'000, DegC(43.0)) == Approx(10'000.0 / (1.0 - 1e-6)).epsilon(1e-12));
}

TEST_CASE("the clock rate wanders with the square root of time") {
    ClockParameters parameters;
    parameters.wander_ppm_per_sqrt_h = 3.0;
    constexpr int kSeeds = 300;
    double square = 0.0;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        const SensorClock clock(parameters, kReference, kClockStart, seed);
        const double late_s = seconds_at(clock, 3600, kReference) - 3600.0;
        square += late_s * late_s / kSeeds;
    }
    // The integral of a random walk: variance rate^2 t^3 / 3, after an hour (3e-6)^2 / 3 h^2.
    const double expected_s2 = 9e-12 / 3.0 * 3600.0 * 3600.0;
    CHECK(square == Approx(expected_s2).epsilon(0.25));
}

TEST_CASE("the clock changes the times of the samples and not their values") {
    const Scenario truth = load_scenario("tsukuba");
    const Scenario fast = changed("tsukuba",
                                  "[clock]\nerror_ppm = 50\nwander_ppm_per_sqrt_h = 0.1\n"
                                  "temperature_ppm_per_degc = 0.5\n");
    signal::Source steady(truth, a351_profile(), 2), moved(fast, a351_profile(), 2);
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

TEST_CASE(
    "the tide agrees with a worked example of Longman's formulas, in proportion to the factor") {
    // Computed without this code: 40.7914 N, 282.1414 E, 370 m, 2015-04-23 00:00 UT, factor
    // 1.1575: 0.00354 mGal upward.
    const UtcTime time = *parse_rfc3339("2015-04-23T00:00:00Z");
    const auto tide = [&](double factor) {
        return earth_tide(Degrees(40.7914), Degrees(282.1414), Metres(370.0), time, factor).value();
    };
    CHECK(tide(1.1575) == Approx(-0.00354).margin(5e-6));
    CHECK(tide(1.1575) == Approx(1.1575 * tide(1.0)).epsilon(1e-14));
}

TEST_CASE("the tide of the survey day agrees with the publication's column") {
    // The column is 1.20 times the rigid Earth's tide (tests/golden/tsukuba/README.md), rounded to
    // 0.001 mGal; Longman's formulas are good to 0.003 mGal.
    const text::CsvTable sites = text::read_csv(A351_GOLDEN "/tsukuba/sites.csv");
    const text::CsvTable rows = text::read_csv(A351_GOLDEN "/tsukuba/observations.csv");
    for (std::size_t row = 0; row < rows.row_count(); ++row) {
        std::size_t site = 0;
        while (sites.cell(site, "site") != rows.cell(row, "site")) ++site;
        const UtcTime time = *parse_rfc3339(rows.cell(row, "time_jst") + "+09:00");
        const MilliGal tide = earth_tide(Degrees(sites.number(site, "latitude_deg")),
                                         Degrees(sites.number(site, "longitude_deg")),
                                         Metres(sites.number(site, "altitude_m")), time, 1.20);
        CHECK(tide.value() == Approx(rows.number(row, "earth_tide_mgal")).margin(0.0035));
    }
}
