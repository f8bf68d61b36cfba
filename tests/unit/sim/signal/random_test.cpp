#include "sim/noise/random.hpp"

#include <cmath>
#include <vector>
#include "tests/support/catch.hpp"

using a351::sim::noise::normal_quantile;
using a351::sim::noise::RandomStream;

TEST_CASE("the same seed and name give the same draws, another seed or name gives others",
          "[sim][random]") {
    RandomStream first(7, "ground"), again(7, "ground"), other_seed(8, "ground"),
        other_name(7, "white");
    int equal_to_other = 0;
    for (int i = 0; i < 1000; ++i) {
        const std::uint64_t draw = first.bits();
        REQUIRE(draw == again.bits());
        equal_to_other += draw == other_seed.bits() ? 1 : 0;
        equal_to_other += draw == other_name.bits() ? 1 : 0;
    }
    CHECK(equal_to_other == 0);
}

TEST_CASE("the quantile inverts the normal distribution function in all its branches",
          "[sim][random]") {
    for (const double p :
         {1e-300, 1e-20, 1e-12, 1e-6, 0.01, 0.07, 0.3, 0.5, 0.92, 0.99, 0.999999}) {
        const double x = normal_quantile(p);
        // erfc is Phi to full precision: Phi(x) = erfc(-x / sqrt 2) / 2.  A relative error d of x
        // causes a relative error of p of up to x^2 d.
        CHECK(0.5 * std::erfc(-x / std::sqrt(2.0)) ==
              Approx(p).epsilon(1e-14 * (1.0 + x * x)).margin(0.0));
    }
}

TEST_CASE("normal draws have the moments of the normal distribution and no correlation",
          "[sim][random]") {
    constexpr int kCount = 1'000'000;
    RandomStream stream(1, "moments");
    double sum = 0.0, square = 0.0, fourth = 0.0, product = 0.0, before = 0.0;
    for (int i = 0; i < kCount; ++i) {
        const double x = stream.normal();
        sum += x;
        square += x * x;
        fourth += x * x * x * x;
        product += x * before;
        before = x;
    }
    // Five standard errors of each estimate.
    const double error = 5.0 / std::sqrt(kCount);
    CHECK(std::abs(sum / kCount) < error);
    CHECK(std::abs(square / kCount - 1.0) < error * std::sqrt(2.0));
    CHECK(std::abs(fourth / kCount - 3.0) < error * std::sqrt(96.0));
    CHECK(std::abs(product / kCount) < error);
}

TEST_CASE("exponential draws have the mean waiting time of a Poisson event", "[sim][random]") {
    constexpr int kCount = 100'000;
    RandomStream stream(3, "waits");
    double sum = 0.0;
    for (int i = 0; i < kCount; ++i) sum += stream.exponential();
    CHECK(std::abs(sum / kCount - 1.0) < 5.0 / std::sqrt(kCount));
}
