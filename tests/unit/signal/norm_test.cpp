#include "protocol/signal/norm.hpp"

#include <cmath>
#include <limits>
#include "tests/support/catch.hpp"

namespace a351::signal {
namespace {

TimeSeries<StandardGravity> axis(std::vector<double> values) {
    return {UtcTime{}, Hertz(50), std::move(values)};
}

}  // namespace

TEST_CASE("the norm does not depend on the orientation of the axes, and is missing with a sample") {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    const auto result =
        norm(axis({0.6, 0.0, 1.0, 0.0}), axis({0.0, 0.6, 0.0, kNan}), axis({0.8, -0.8, 0.0, 1.0}));
    for (std::size_t i = 0; i < 3; ++i) CHECK(result.values()[i] == Approx(1.0).epsilon(1e-15));
    CHECK(std::isnan(result.values()[3]));
}

TEST_CASE("axes on different grids are refused") {
    const auto x = axis({0.0, 1.0});
    const TimeSeries<StandardGravity> later(UtcTime{} + Nanoseconds(1), Hertz(50), {0.0, 1.0});
    const TimeSeries<StandardGravity> faster(UtcTime{}, Hertz(51), {0.0, 1.0});
    CHECK_THROWS_AS(norm(x, axis({0.0}), x), std::invalid_argument);
    CHECK_THROWS_AS(norm(x, x, later), std::invalid_argument);
    CHECK_THROWS_AS(norm(x, faster, x), std::invalid_argument);
}

}  // namespace a351::signal
