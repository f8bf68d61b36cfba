// Tide at single places and instants against a harmonic catalogue and against Longman's formulas.
// Data and their origin: tests/golden/tide/README.md.
#include <string>
#include "tests/support/catch.hpp"

#include "corrector/tide/earth_tide.hpp"
#include "protocol/text/csv.hpp"

using namespace a351::corrector;
using namespace a351;
using namespace a351::corrector::tide;

namespace {

struct Point {
    UtcTime time;
    tide::Station station;
    double rigid_mgal = 0.0;
    double elastic_mgal = 0.0;
    double longman_mgal = 0.0;
};

/// The point with that number; the file holds 1 to 8 in order.
Point point(std::size_t id) {
    const auto table = text::read_csv(A351_GOLDEN "/tide/points.csv");
    const std::size_t row = id - 1;
    REQUIRE(table.cell(row, "id") == std::to_string(id));
    return {parse_rfc3339(table.cell(row, "time_utc")).value(),
            {Degrees(table.number(row, "latitude_deg")),
             Degrees(table.number(row, "longitude_deg")), Metres(table.number(row, "height_m"))},
            table.number(row, "rigid_mgal"),
            table.number(row, "elastic_model_mgal"),
            table.number(row, "longman_rigid_mgal")};
}

}  // namespace

TEST_CASE("the direct tide of a rigid Earth is within 0.0001 mGal of the harmonic catalogue") {
    const std::size_t id = GENERATE(range(std::size_t(1), std::size_t(9)));
    CAPTURE(id);
    const Point p = point(id);
    CHECK(direct_tide(p.time, p.station, kRigidEarth).value() ==
          Approx(p.rigid_mgal).margin(0.0001).epsilon(0));
}

TEST_CASE("the direct tide times 1.16 is within 0.0012 mGal of the elastic model") {
    const std::size_t id = GENERATE(range(std::size_t(1), std::size_t(9)));
    CAPTURE(id);
    const Point p = point(id);
    CHECK(direct_tide(p.time, p.station, {1.16, 1.16}).value() ==
          Approx(p.elastic_mgal).margin(0.0012).epsilon(0));
}

TEST_CASE("Longman's tide repeats the column computed from his formulas") {
    // The column is printed to 0.00001; twice the rounding.
    const std::size_t id = GENERATE(range(std::size_t(1), std::size_t(9)));
    CAPTURE(id);
    const Point p = point(id);
    CHECK(longman_tide(p.time, p.station, kRigidEarth).value() ==
          Approx(p.longman_mgal).margin(0.00001).epsilon(0));
}

TEST_CASE("Longman's tide is within 0.0016 mGal of the harmonic catalogue") {
    const std::size_t id = GENERATE(range(std::size_t(1), std::size_t(9)));
    CAPTURE(id);
    const Point p = point(id);
    CHECK(longman_tide(p.time, p.station, kRigidEarth).value() ==
          Approx(p.rigid_mgal).margin(0.0016).epsilon(0));
}

TEST_CASE("Longman's tide has the value published with a widely used implementation") {
    // 40.7914 N, 282.1414 E, 370 m, 2015-04-23: 0.00354 mGal upward with the factor 1.1575.
    const tide::Station station{Degrees(40.7914), Degrees(282.1414), Metres(370.0)};
    const UtcTime time = parse_rfc3339("2015-04-23T00:00:00Z").value();
    CHECK(longman_tide(time, station).value() == Approx(-0.00354).margin(0.000005).epsilon(0));
}
