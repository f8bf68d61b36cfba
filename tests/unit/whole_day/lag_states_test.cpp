#include "corrector/whole_day/lag_states.hpp"

#include <cmath>
#include <random>
#include "tests/support/catch.hpp"

#include "protocol/unit/thermal_response.hpp"

using namespace a351;
using namespace a351::corrector::reading;
using namespace a351::corrector::whole_day;

namespace {

const UtcTime kFirstMinute = *parse_rfc3339("2026-05-01T00:00:00Z");

/// Returns a day at 2 s that follows its mean with a time constant of 20 min, as an oven does.
std::vector<double> course_degc(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::vector<double> degc(43200);
    double value = 0.0;
    for (double& sample : degc) {
        value += -value * 2.0 / 1200.0 + 0.01 * normal(random);
        sample = 42.5 + value;
    }
    return degc;
}

TimeSeries<DegC> series(std::vector<double> degc) {
    return {kFirstMinute, Hertz(0.5), std::move(degc)};
}

}  // namespace

TEST_CASE("what a gap leaves unknown of the lags is as large as other stretches of the day show") {
    constexpr double kFastLag_s = 43.0, kSlowLag_s = 2700.0;
    constexpr std::size_t kBefore = 20000, kAfter = kBefore + 1800;  // an hour
    double fast_true = 0.0, slow_true = 0.0, fast_said = 0.0, slow_said = 0.0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        const std::vector<double> degc = course_degc(seed);
        std::vector<double> bridged = degc;
        for (std::size_t i = kBefore + 1; i < kAfter; ++i)
            bridged[i] = degc[kBefore] + (degc[kAfter] - degc[kBefore]) *
                                             static_cast<double>(i - kBefore) / (kAfter - kBefore);
        const auto error = [&](double lag_s) {
            return unit::lagged(series(degc), lag_s)[kAfter] -
                   unit::lagged(series(bridged), lag_s)[kAfter];
        };
        fast_true += std::pow(error(kFastLag_s), 2);
        slow_true += std::pow(error(kSlowLag_s), 2);
        const auto states =
            lag_states({series(bridged), {{kBefore, kAfter}}}, kFastLag_s, kSlowLag_s);
        REQUIRE(states.size() == 1);
        CHECK(seconds_between(kFirstMinute, states[0].from) == 2.0 * kAfter);
        fast_said += std::pow(states[0].fast_sd_degc, 2);
        slow_said += std::pow(states[0].slow_sd_degc, 2);
    }
    CHECK(std::sqrt(fast_said / fast_true) == Approx(1.0).epsilon(0.15));
    CHECK(std::sqrt(slow_said / slow_true) == Approx(1.0).epsilon(0.15));
}

TEST_CASE("a day that is mostly a gap has the scatter of its temperature as upper limit") {
    std::vector<double> degc(1000, 42.0);
    for (std::size_t i = 500; i < 1000; ++i) degc[i] = 43.0;
    const auto states = lag_states({series(degc), {{100, 900}}}, 43.0, 2700.0);
    REQUIRE(states.size() == 1);
    CHECK(states[0].slow_sd_degc == Approx(0.5));
    CHECK(lag_states({series(degc), {}}, 43.0, 2700.0).empty());
}

TEST_CASE("a state fades with its lag, and does not exist before its gap ends") {
    DayBin bin;
    for (int i = 0; i < 10; ++i) bin.times.push_back(kFirstMinute + from_seconds(2.0 * i));
    CHECK(remaining(bin, kFirstMinute + from_seconds(60.0), 43.0) == 0.0);
    CHECK(remaining(bin, kFirstMinute - from_seconds(2700.0), 2700.0) ==
          Approx(std::exp(-1.0)).epsilon(0.01));
    CHECK(remaining(bin, kFirstMinute + from_seconds(9.0), 1e9) == Approx(0.5));
}
