#include "protocol/signal/norm.hpp"

#include <cmath>
#include <limits>
#include "tests/support/catch.hpp"

#include "tests/unit/reading/record.hpp"

namespace a351::corrector {
namespace {

/// Mean of the valid outputs less gravity, for axes that vibrate sideways.
double bias_mgal(NormOrder order, double rms_gal) {
    const auto x = vibrating_axis(60'000, 0.0, rms_gal, 7.3);
    const auto y = vibrating_axis(60'000, 0.0, rms_gal, 11.9);
    const auto z = vibrating_axis(60'000, 1.0, 0.0, 1.0);
    const auto result = decimated_norm(x, y, z, order, design_decimation(10), 2);
    double sum = 0.0;
    for (std::size_t k = 5; k <= 595; ++k) sum += result.values()[k] - 980'665.0;
    return sum / 591.0;
}

}  // namespace

TEST_CASE("the norm does not depend on how the axes point") {
    const auto x = TimeSeries<StandardGravity>(UtcTime{}, Hertz(50), {0.6, 0.0, 1.0});
    const auto y = TimeSeries<StandardGravity>(UtcTime{}, Hertz(50), {0.0, 0.6, 0.0});
    const auto z = TimeSeries<StandardGravity>(UtcTime{}, Hertz(50), {0.8, -0.8, 0.0});
    const TimeSeries<StandardGravity> result = norm(x, y, z);
    for (const double value : result.values()) CHECK(value == Approx(1.0).epsilon(1e-15));
}

TEST_CASE("the norm is missing where an axis is") {
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

TEST_CASE("sideways vibration makes the norm of raw samples too large by the rectification bias") {
    for (const double rms_gal : {1.0, 2.0}) {
        const MilliGal rms(1000.0 * rms_gal);
        const double expected = rectification_bias(rms, rms, MilliGal(980'665.0)).value();
        CHECK(expected == Approx(1.02 * rms_gal * rms_gal).margin(0.01));
        CHECK(bias_mgal(NormOrder::as_published, rms_gal) == Approx(expected).epsilon(1e-3));
    }
}

TEST_CASE("the norm of decimated axes is free of the rectification bias") {
    CHECK(std::abs(bias_mgal(NormOrder::decimate_first, 1.0)) < 1e-4);
}

}  // namespace a351::corrector
