#include "protocol/signal/norm.hpp"

#include <cmath>
#include <limits>
#include "tests/support/catch.hpp"

namespace a351::signal {
TEST_CASE("the norm does not depend on the orientation of the axes") {
    const auto x = TimeSeries<StandardGravity>(UtcTime{}, Hertz(50), {0.6, 0.0, 1.0});
    const auto y = TimeSeries<StandardGravity>(UtcTime{}, Hertz(50), {0.0, 0.6, 0.0});
    const auto z = TimeSeries<StandardGravity>(UtcTime{}, Hertz(50), {0.8, -0.8, 0.0});
    const TimeSeries<StandardGravity> result = norm(x, y, z);
    for (const double value : result.values()) CHECK(value == Approx(1.0).epsilon(1e-15));
}

TEST_CASE("the norm is missing if a sample of an axis is missing") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto x = TimeSeries<StandardGravity>(UtcTime{}, Hertz(50), {0.0, nan});
    const auto z = TimeSeries<StandardGravity>(UtcTime{}, Hertz(50), {1.0, 1.0});
    CHECK_FALSE(std::isnan(norm(x, x, z).values()[0]));
    CHECK(std::isnan(norm(x, x, z).values()[1]));
}

TEST_CASE("axes on different grids are refused") {
    const auto x = TimeSeries<StandardGravity>(UtcTime{}, Hertz(50), {0.0, 1.0});
    const auto shorter = TimeSeries<StandardGravity>(UtcTime{}, Hertz(50), {0.0});
    const auto later =
        TimeSeries<StandardGravity>(UtcTime{} + Nanoseconds(1), Hertz(50), {0.0, 1.0});
    const auto faster = TimeSeries<StandardGravity>(UtcTime{}, Hertz(51), {0.0, 1.0});
    CHECK_THROWS_AS(norm(x, shorter, x), std::invalid_argument);
    CHECK_THROWS_AS(norm(x, x, later), std::invalid_argument);
    CHECK_THROWS_AS(norm(x, faster, x), std::invalid_argument);
}

}  // namespace a351::signal
