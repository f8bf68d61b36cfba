// The permanent tide against a catalogue, a formula and its own mean, and what each tide system keeps of it.
#include <cmath>
#include <vector>
#include "tests/support/catch.hpp"

#include "corrector/tide/permanent_tide.hpp"
#include "protocol/text/csv.hpp"

using namespace a351;
using namespace a351::corrector;
using namespace a351::corrector::tide;

namespace {

tide::Station at(double latitude_deg, double longitude_deg, double height_m) {
    return {Degrees(latitude_deg), Degrees(longitude_deg), Metres(height_m)};
}

/// The places of tests/golden/tide/systems.csv: 20 of all latitudes, on both hemispheres.
struct Place {
    UtcTime time;
    tide::Station station;
    double rigid_mgal = 0.0, without_permanent_mgal = 0.0;
};

std::vector<Place> places() {
    const auto table = text::read_csv(A351_GOLDEN "/tide/systems.csv");
    std::vector<Place> all;
    for (std::size_t row = 0; row < table.row_count(); ++row)
        all.push_back({parse_rfc3339(table.cell(row, "time_utc")).value(),
                       at(table.number(row, "latitude_deg"), table.number(row, "longitude_deg"),
                          table.number(row, "height_m")),
                       table.number(row, "rigid_mgal"),
                       table.number(row, "without_permanent_mgal")});
    REQUIRE(all.size() == 20);
    return all;
}

}  // namespace

TEST_CASE("each tide system agrees with ETERNA's catalogue at 20 places") {
    for (const Place& one : places()) {
        CAPTURE(one.station.latitude.value());
        const auto rigid = [&](System system) {
            return earth_tide(tide::Model::direct, one.time, one.station, kRigidEarth, system)
                .value();
        };
        CHECK(rigid(System::tide_free) == Approx(one.rigid_mgal).margin(0.0001).epsilon(0));
        CHECK(rigid(System::mean) == Approx(one.without_permanent_mgal).margin(0.0001).epsilon(0));
        CHECK(permanent_tide(one.station).value() ==
              Approx(one.rigid_mgal - one.without_permanent_mgal).margin(0.00002).epsilon(0));
    }
}

TEST_CASE("the permanent tide is that of Ekman's formula at 20 places") {
    // M. Ekman, Bull. Geod. 63, 281-296, 1989: mean minus zero gravity, -30.4 + 91.2 sin^2(lat) uGal.
    for (const auto& [time, station, rigid, rest] : places()) {
        const double sine = std::sin(station.latitude.value() * kRadPerDeg);
        CAPTURE(station.latitude.value());
        CHECK(permanent_tide(station).value() ==
              Approx(-0.0304 + 0.0912 * sine * sine).margin(0.0002).epsilon(0));
    }
}

TEST_CASE("the permanent tide is the mean of the tide over 18.6 years at 20 places") {
    // Two revolutions of the Moon's node from 1998 on.  The step is no part of a day, a month or a
    // year, so that each angle is sampled evenly.
    constexpr double kNode_s = 2 * 6798.38 * 86400.0;
    constexpr int kSteps = 20011;
    const UtcTime begin = *parse_rfc3339("1998-01-01T00:00:00Z");
    for (const auto& [time, station, rigid, rest] : places()) {
        double sum_mgal = 0.0;
        for (int i = 0; i < kSteps; ++i)
            sum_mgal +=
                direct_tide(begin + from_seconds(kNode_s * i / kSteps), station, kRigidEarth)
                    .value();
        CAPTURE(station.latitude.value(), station.longitude.value());
        CHECK(permanent_tide(station).value() ==
              Approx(sum_mgal / kSteps).margin(0.0002).epsilon(0));
    }
}

TEST_CASE("systems of gravity differ by constants that depend on the latitude alone") {
    const UtcTime time = *parse_rfc3339("2017-07-16T03:00:00Z");
    const Factors factors;
    const auto remaining = [&](System system, double latitude_deg, tide::Model model) {
        const tide::Station station = at(latitude_deg, 140.1, 0.0);
        // Gravity that remains after the tide is subtracted, minus that of tide-free.
        return (earth_tide(model, time, station, factors) -
                earth_tide(model, time, station, factors, system))
            .value();
    };
    for (const tide::Model model : {tide::Model::direct, tide::Model::longman}) {
        CHECK(remaining(System::mean, 0.0, model) == Approx(-0.0354).margin(0.0001));
        CHECK(remaining(System::mean, 90.0, model) == Approx(0.0705).margin(0.0001));
        CHECK(remaining(System::mean, -90.0, model) == Approx(0.0705).margin(0.0001));
        CHECK(remaining(System::zero, 0.0, model) == Approx(-0.0049).margin(0.0001));
        CHECK(remaining(System::zero, -90.0, model) == Approx(0.0097).margin(0.0001));
        CHECK(remaining(System::tide_free, 36.0, model) == 0.0);
    }
    CHECK(earth_tide(tide::Model::none, time, at(0, 0, 0), factors, System::mean) == MilliGal(0.0));
    for (const System system : {System::tide_free, System::zero, System::mean})
        CHECK(system_named(name_of(system)) == system);
    CHECK_FALSE(system_named("free").has_value());
}
