#include "protocol/core/units.hpp"

#include "tests/support/catch.hpp"

using namespace a351;

TEST_CASE("one standard gravity is 980665 mGal, in both directions of the conversion") {
    // 3rd CGPM, 1901: g = 9.80665 m/s2; 1 mGal = 1e-5 m/s2.
    CHECK(to_milligal(StandardGravity(1.0)).value() == 980665.0);
    CHECK(to_standard_gravity(MilliGal(980665.0)).value() == 1.0);
}

TEST_CASE("arithmetic and comparison keep the unit") {
    CHECK(MilliGal(2.0) + MilliGal(0.5) == MilliGal(2.5));
    CHECK(MilliGal(2.0) - MilliGal(0.5) == MilliGal(1.5));
    CHECK(2.0 * -DegC(3.0) == DegC(-6.0));
    CHECK(Hertz(49.9) < Hertz(50.0));
    CHECK_FALSE(std::is_convertible_v<double, MilliGal>);
    CHECK_FALSE(std::is_convertible_v<MilliGal, double>);
    CHECK_FALSE(std::is_constructible_v<MilliGal, DegC>);
}
