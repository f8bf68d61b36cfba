#include "daemon/believable/temperature_format.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "daemon/believable/limits.hpp"
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::daemon::believable;

namespace {

/// Returns counts of a temperature that moves by 0.02 degC, as a unit of this format sends them.
TemperatureCounts counts_of(const TemperatureFormat& format, double degc) {
    // Counts of a 65536th of a step are multiples of 65536.
    const double step = std::abs(format.slope_degc) < 1e-6 ? 65536.0 : 1.0;
    const auto counts = [&](double at) {
        return static_cast<std::int32_t>(
            step * std::round((at - format.offset_degc) / (format.slope_degc * step)));
    };
    const std::int32_t begin = counts(degc - 0.01), end = counts(degc + 0.01);
    return {std::min(begin, end), std::max(begin, end), 0.5 * (double(begin) + end)};
}

}  // namespace

TEST_CASE("the counts of 42.5 degC read as published in the other formats") {
    const std::array<std::int32_t, 3> counts{-1981, -129'826'816, 43'520};
    // Rows: the format of the unit; columns: that of the reader, degC.
    const std::array<std::array<double, 3>, 3> expected{
        {{42.4986, 34.9871, -1.9346}, {492312.4, 42.4986, -126784.0}, {-130.032, 34.9845, 42.5}}};
    const std::array<std::array<bool, 3>, 3> possible{
        {{true, false, true}, {false, true, false}, {false, false, true}}};
    for (std::size_t unit = 0; unit < 3; ++unit) {
        const TemperatureCounts seen{counts[unit], counts[unit], double(counts[unit])};
        for (std::size_t reader = 0; reader < 3; ++reader) {
            const TemperatureFormat& format = temperature_formats()[reader];
            CHECK(format.temperature(seen).value() == Approx(expected[unit][reader]).epsilon(1e-4));
            CHECK(format.is_possible(seen) == possible[unit][reader]);
        }
    }
}

TEST_CASE("a register without a value has no format") {
    for (const std::int32_t empty : {0, -1})
        CHECK(fitting_formats({empty, empty, double(empty)}, format_of(*wire::find_profile("A351")))
                  .empty());
}

TEST_CASE("the format of a unit is found from 7.5 to 60 degC, whatever the profile") {
    for (const TemperatureFormat& unit : temperature_formats())
        for (const TemperatureFormat& reader : temperature_formats())
            for (double degc = 7.5; degc <= 60.0; degc += 2.5) {
                const auto fits = fitting_formats(counts_of(unit, degc), reader);
                INFO(unit.formula << " read as " << reader.formula << ", " << degc << " degC");
                REQUIRE(!fits.empty());
                CHECK(fits[0].format.slope_degc == unit.slope_degc);
                CHECK(fits[0].temperature.value() == Approx(degc).margin(0.01));
                CHECK(fits[0].is_of_profile == (unit.slope_degc == reader.slope_degc));
            }
}

TEST_CASE("with the oven's temperature the format of a unit is found below 7 degC, too") {
    const auto& formats = temperature_formats();
    const auto finds = [&](std::size_t unit, std::size_t reader, double degc) {
        const auto fits =
            fitting_formats(counts_of(formats[unit], degc), formats[reader], DegC(degc + 1.0));
        return fits.size() == 1 && fits[0].format.slope_degc == formats[unit].slope_degc;
    };
    for (const double degc : {-20.0, -5.0, 0.0, 42.0}) {
        CHECK(finds(0, 2, degc));
        CHECK(finds(2, 0, degc));
    }
}

TEST_CASE("a format of the user fits if it gives a usual temperature") {
    // 500 counts are 33.1 degC in the format of the M-A352AD10, which is nearer to 30 degC.
    const auto fits = fitting_formats({495, 505, 500.0}, {"", 0.01, 20.0});
    REQUIRE(!fits.empty());
    CHECK(fits[0].is_of_profile);
    CHECK(fits[0].temperature.value() == Approx(25.0));
    const auto other = fitting_formats({495, 505, 500.0}, {"", 0.01, 70.0});
    REQUIRE(!other.empty());
    CHECK(other[0].format.formula == std::string("N x -0.0037918 + 34.987"));
}

TEST_CASE("half, double and quarter scales are not a box at rest") {
    for (const double gravity_g : {0.997, 1.003}) {
        for (const double bias_g : {-0.05, 0.05})
            CHECK(is_norm_believable(StandardGravity(gravity_g + bias_g)));
        for (const double factor : {0.25, 0.5, 2.0, 4.0})
            CHECK_FALSE(is_norm_believable(StandardGravity(factor * gravity_g)));
    }
    CHECK_FALSE(is_norm_believable(StandardGravity(std::nan(""))));
}
