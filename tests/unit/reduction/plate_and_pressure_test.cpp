#include "corrector/reduction/plate_and_pressure.hpp"

#include <cmath>
#include <limits>

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::reduction;

TEST_CASE("a plate of a metre of rock attracts by 0.1120 mGal") {
    CHECK(bouguer_plate(Metres(1.0), kCrust_kg_per_m3).value() == Approx(0.11197).margin(0.000005));
    CHECK(bouguer_plate(Metres(-100.0), 1000.0).value() == Approx(-4.1936).margin(0.0001));
}

TEST_CASE("the standard atmosphere has the pressures of its tables") {
    // ISO 2533:1975, table 1.
    CHECK(normal_pressure_hpa(Metres(0.0)) == 1013.25);
    CHECK(normal_pressure_hpa(Metres(1000.0)) == Approx(898.75).margin(0.02));
    CHECK(normal_pressure_hpa(Metres(3000.0)) == Approx(701.09).margin(0.02));
    // The nominal pressures of an absolute gravimeter, tests/golden/usgs/rg26_ and rg36_2017-12-01.
    CHECK(normal_pressure_hpa(Metres(1630.83)) == Approx(832.07).epsilon(0.0).margin(0.005));
    CHECK(normal_pressure_hpa(Metres(1630.0)) == Approx(832.16).epsilon(0.0).margin(0.005));
}

TEST_CASE("a height that is not a number gives neither attraction nor pressure") {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    CHECK(std::isnan(bouguer_plate(Metres(kNaN), 2670.0).value()));
    CHECK(std::isnan(normal_pressure_hpa(Metres(kNaN))));
}
