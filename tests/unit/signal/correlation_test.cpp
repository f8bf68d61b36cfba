#include <cmath>
#include <random>
#include "tests/support/catch.hpp"

#include "protocol/signal/moments.hpp"
#include "protocol/signal/regression.hpp"

using namespace a351::signal;

namespace {

/// Returns noise of which each value keeps a part of the value before.
std::vector<double> noise(unsigned seed, double kept) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::vector<double> values(2000);
    double before = 0.0;
    for (double& value : values) value = before = kept * before + normal(random);
    return values;
}

}  // namespace

TEST_CASE("moments of large numbers keep their digits, and none have none") {
    const std::vector<double> readings{980000.1, 980000.1, 980000.1}, spread{980000.0, 980000.003};
    CHECK(mean_of(readings) == 980000.1);
    CHECK(variance_of(readings) == 0.0);
    CHECK(sample_sd_of(spread) == Approx(0.003 / std::sqrt(2.0)).epsilon(1e-7));
    CHECK(std::isnan(mean_of({})));
    CHECK(std::isnan(variance_of({})));
    CHECK(std::isnan(sample_sd_of(std::vector<double>{1.0})));
}

TEST_CASE("correlations reach to the lag that is asked for, and peaks are near zero") {
    std::vector<double> first, later;
    for (int i = 0; i < 1000; ++i) {
        first.push_back(std::sin(0.1 * i));
        later.push_back(std::sin(0.1 * (i - 7)));
    }
    const CrossCorrelation all = correlate(first, later, 31, 200, 20.0);
    CHECK(all.delays_s.front() == -4000.0);
    CHECK(all.delays_s.back() == 4000.0);
    CHECK(all.positive.delay_s == Approx(140.0).margin(2.0));
}

TEST_CASE(
    "unrelated series exceed the limits of chance at 5 % of the lags, also if each follows "
    "itself") {
    for (const double kept : {0.0, 0.9}) {
        int outside = 0, all = 0;
        double limit = 0.0;
        for (unsigned seed = 1; seed <= 20; ++seed) {
            const std::vector<double> one = noise(seed, kept), other = noise(seed + 100, kept);
            limit = chance_correlation(one, other, 200);
            for (const double value : correlate(one, other, 10, 100, 1.0).values) {
                ++all;
                outside += std::abs(value) > limit ? 1 : 0;
            }
        }
        CAPTURE(kept);
        CHECK(static_cast<double>(outside) / all == Approx(0.05).margin(0.025));
        // White noise: 1.96 / sqrt(2000); else sqrt((1 + 0.81) / (1 - 0.81)) of it.
        CHECK(limit == Approx(kept == 0.0 ? 0.0438 : 0.1353).epsilon(0.15));
    }
}
