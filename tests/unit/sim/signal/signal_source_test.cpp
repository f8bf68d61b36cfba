#include "sim/signal/signal_source.hpp"

#include <cmath>
#include <limits>
#include "tests/support/catch.hpp"

#include "sim/signal/earth_tide.hpp"

using namespace a351::sim;
using namespace a351;
using namespace a351::sim::scenario;
using namespace a351::sim::signal;

namespace {

const wire::DeviceProfile& a351_profile() { return *wire::find_profile("A351"); }

/// Returns the length of the acceleration vector.
double norm_mgal(const SensorSample& sample) {
    double square = 0.0;
    for (const std::int32_t axis : sample.axes_counts) {
        const double mgal = to_milligal(a351_profile().acceleration(axis)).value();
        square += mgal * mgal;
    }
    return std::sqrt(square);
}

struct Means {
    double residual_mgal = 0.0;  ///< Norm minus gravity, tide and bias.
    double norm_rms_mgal = 0.0;  ///< Scatter of single samples.
};

/// Returns the means over each occupation without its first and last minute.
std::vector<Means> occupation_means(const std::string& name, std::uint64_t seed) {
    const Scenario scenario = load_scenario(name);
    signal::Source source(scenario, a351_profile(), seed);
    std::vector<Means> means;
    for (const PlannedSetUp& occupation : source.plan()) {
        const text::Site& site = occupation.site;
        double sum = 0.0, square = 0.0;
        int count = 0;
        while (*source.next_instant() < occupation.end - std::chrono::seconds(60)) {
            const UtcTime time = *source.next_instant();
            const SensorSample sample = source.next().values;
            if (time < occupation.start + std::chrono::seconds(60)) continue;
            const double residual_mgal = norm_mgal(sample) - site.gravity->value() -
                                         scenario.sensor.bias_mgal -
                                         earth_tide(site.latitude, site.longitude, site.altitude,
                                                    time, scenario.tide.gravimetric_factor)
                                             .value();
            sum += residual_mgal;
            square += residual_mgal * residual_mgal;
            ++count;
        }
        means.push_back({sum / count, std::sqrt(square / count)});
    }
    return means;
}

}  // namespace

TEST_CASE("the same seed gives the same samples, another seed others", "[sim][signal_source]") {
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

TEST_CASE("samples lie on a grid of 20 ms from the scenario's start", "[sim][signal_source]") {
    const Scenario scenario = load_scenario("tsukuba");
    signal::Source source(scenario, a351_profile(), 1);
    CHECK(source.next().instant == scenario.start());
    CHECK(*source.next_instant() - scenario.start() == std::chrono::milliseconds(20));
    CHECK(static_cast<double>(source.sample_count()) / 50.0 / 3600.0 == Approx(13.2).margin(0.01));
}

TEST_CASE("an ideal day reads gravity, tide and bias and nothing else", "[sim][signal_source]") {
    for (const Means& mean : occupation_means("ideal", 3)) {
        // 0.1 mGal of dither over at least 21 000 samples, and 0.058 mGal counts: 1 uGal.
        CHECK(std::abs(mean.residual_mgal) < 0.004);
        CHECK(mean.norm_rms_mgal < 0.15);
    }
}

TEST_CASE("counts are limited to the range of their type", "[sim][signal_source]") {
    CHECK(to_counts(2.5) == 3);
    CHECK(to_counts(-2.5) == -2);
    CHECK(to_counts(1e12) == std::numeric_limits<std::int32_t>::max());
    CHECK(to_counts(-1e12) == std::numeric_limits<std::int32_t>::min());
    CHECK(to_counts(std::numeric_limits<double>::infinity()) ==
          std::numeric_limits<std::int32_t>::max());
    CHECK(to_counts(std::nan("")) == std::numeric_limits<std::int32_t>::min());
}

TEST_CASE("the bias of axis z stays on it when the box is turned", "[sim][signal_source]") {
    const Scenario scenario = parse_scenario(
        "base = \"ideal\"\nname = \"x\"\n[schedule]\nlead_in_h = 0.1\njitter_s = 0\n"
        "[sensor]\nwhite_mgal = 0.0\n[[occupation]]\nsite = \"No.1\"\nambient_degc = 25\n"
        "centre_utc = \"2017-07-16T00:00:00Z\"\nabout_y_deg = [30]\nabout_x_deg = [0]\n",
        "x.toml");
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

TEST_CASE("a tilted unit has an error from its horizontal bias that differs at each levelling",
          "[sim][signal_source]") {
    std::vector<Means> tilted = occupation_means("tilted", 3);
    const std::vector<Means> upright = occupation_means("tsukuba", 3);
    double low = 1e9, high = -1e9;
    for (std::size_t i = 0; i < tilted.size(); ++i) {
        const double difference = tilted[i].residual_mgal - upright[i].residual_mgal;
        low = std::min(low, difference);
        high = std::max(high, difference);
    }
    // Up to 2 Gal sin 0.1 deg = 3.5 mGal per axis and standard deviation of the levelling.
    CHECK(high - low > 2.0);
    CHECK(high - low < 40.0);
}
