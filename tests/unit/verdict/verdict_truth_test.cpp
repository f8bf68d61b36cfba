#include "tests/support/verdict_truth.hpp"

#include <cmath>
#include <numbers>
#include "tests/support/catch.hpp"

namespace a351::sim {
namespace {

/// Returns three hours of a ramp with the cycle of a settled oven.
std::vector<double> error_course(double mgal_per_10_min, double cycle_mgal) {
    std::vector<double> error;
    for (int s = 0; s < 10800; ++s) {
        error.push_back(mgal_per_10_min * s / 600.0 +
                        cycle_mgal * std::sin(2.0 * std::numbers::pi * s / kCycleSeconds));
    }
    return error;
}

TEST_CASE("the oven's cycle does not count as unsteady", "[verdict][truth]") {
    const auto mean = cycle_mean(error_course(0.0, 3.0));
    CHECK(std::isnan(mean[449]));
    for (std::size_t i = 450; i < mean.size() - 450; ++i) REQUIRE(std::abs(mean[i]) < 1e-9);
    CHECK(allowed(mean, {})[5000] == Allowed::yes);
}

TEST_CASE("the limit is a change of 2 mGal in 10 min, in either direction", "[verdict][truth]") {
    for (const double sign : {1.0, -1.0}) {
        CHECK(allowed(cycle_mean(error_course(1.99 * sign, 3.0)), {})[5000] == Allowed::yes);
        CHECK(allowed(cycle_mean(error_course(2.01 * sign, 3.0)), {})[5000] == Allowed::no);
    }
}

TEST_CASE("a change within the next 10 min counts now", "[verdict][truth]") {
    std::vector<double> mean(4000, 0.0);
    for (std::size_t i = 2000; i < mean.size(); ++i) mean[i] = 3.0;
    const auto truth = allowed(mean, {});
    CHECK(truth[1399] == Allowed::yes);
    CHECK(truth[1400] == Allowed::no);
    CHECK(truth[1999] == Allowed::no);
    CHECK(truth[2000] == Allowed::yes);
}

TEST_CASE("a touch counts from its start until a minute after its end", "[verdict][truth]") {
    const std::vector<double> mean(4000, 0.0);
    const std::vector<Touch> touches{{1000.0, 1010.0}};
    const auto truth = allowed(mean, touches);
    CHECK(truth[999] == Allowed::yes);
    CHECK(truth[1000] == Allowed::no);
    CHECK(truth[1069] == Allowed::no);
    CHECK(truth[1070] == Allowed::yes);
}

TEST_CASE("the truth is unknown where the record does not reach", "[verdict][truth]") {
    const auto truth = allowed(cycle_mean(error_course(0.0, 0.0)), {});
    CHECK(truth[449] == Allowed::unknown);
    CHECK(truth[450] == Allowed::yes);
    CHECK(truth[10800 - 1051] == Allowed::yes);
    CHECK(truth[10800 - 1050] == Allowed::unknown);
}

TEST_CASE("a warm-up allows readings only after more than two hours", "[verdict][truth]") {
    const VerdictRecord record = simulated_case(3);
    std::size_t first = 0;
    while (record.truth[first] != Allowed::yes) ++first;
    CHECK(first > 7200);
    CHECK(record.truth.size() == 18000);
    CHECK(record.samples.size() == 8996);
    CHECK(seconds_between(record.samples[7].time, record.samples[7].seen_at) == Approx(10.0));
}

}  // namespace
}  // namespace a351::sim
