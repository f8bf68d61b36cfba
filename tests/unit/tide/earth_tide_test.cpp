#include "corrector/tide/earth_tide.hpp"

#include <cmath>
#include "tests/support/catch.hpp"

using namespace a351::corrector;
using namespace a351;
using namespace a351::corrector::tide;

namespace {

const UtcTime kTime = parse_rfc3339("2017-07-16T03:00:00Z").value();
const tide::Station kStation{Degrees(36.216), Degrees(140.123), Metres(532.0)};

}  // namespace

TEST_CASE("the tide is linear in its two factors") {
    const double degree2 = direct_tide(kTime, kStation, {1.0, 0.0}).value();
    const double degree3 = direct_tide(kTime, kStation, {0.0, 1.0}).value();
    CHECK(direct_tide(kTime, kStation, {1.16, 1.07}).value() ==
          Approx(1.16 * degree2 + 1.07 * degree3).epsilon(1e-12));
    CHECK(std::abs(degree3) < 0.1 * std::abs(degree2) + 0.005);
}

TEST_CASE("gravity is least where the Moon is overhead") {
    // New Moon of 2017-02-26 14:58 UTC, near both nodes and the equator: Moon and Sun pull together
    // and are overhead near local noon, at 0 degrees longitude at 12 UTC.
    const UtcTime noon = parse_rfc3339("2017-02-26T12:00:00Z").value();
    const tide::Station below{Degrees(-8.0), Degrees(0.0), Metres(0.0)};
    const tide::Station aside{Degrees(-8.0), Degrees(90.0), Metres(0.0)};
    CHECK(direct_tide(noon, below, kRigidEarth).value() < -0.1);
    CHECK(direct_tide(noon, aside, kRigidEarth).value() > 0.03);
}

TEST_CASE("360 degrees of longitude more change nothing") {
    const tide::Station turned{kStation.latitude, kStation.longitude - Degrees(360.0),
                               kStation.height};
    CHECK(direct_tide(kTime, turned).value() ==
          Approx(direct_tide(kTime, kStation).value()).epsilon(0).margin(1e-12));
    CHECK(longman_tide(kTime, turned).value() ==
          Approx(longman_tide(kTime, kStation).value()).epsilon(0).margin(1e-12));
}

TEST_CASE("both methods agree within Longman's known error over a month") {
    // 0.0025 mGal: largest deviation of his formulas in this month; over decades see earth_tide.hpp.
    for (int hour = 0; hour < 30 * 24; ++hour) {
        const UtcTime time = kTime + std::chrono::hours(hour);
        CAPTURE(hour);
        CHECK(longman_tide(time, kStation, kRigidEarth).value() ==
              Approx(direct_tide(time, kStation, kRigidEarth).value()).epsilon(0).margin(0.0025));
    }
}

TEST_CASE("the tide model is chosen by name") {
    const tide::Factors factors{1.2, 1.2};
    CHECK(earth_tide(tide::Model::none, kTime, kStation, factors) == MilliGal(0.0));
    CHECK(earth_tide(tide::Model::direct, kTime, kStation, factors) ==
          direct_tide(kTime, kStation, factors));
    CHECK(earth_tide(tide::Model::longman, kTime, kStation, factors) ==
          longman_tide(kTime, kStation, factors));
}
