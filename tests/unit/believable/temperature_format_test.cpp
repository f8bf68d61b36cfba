#include "daemon/believable/temperature_format.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "daemon/believable/limits.hpp"
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::daemon::believable;

namespace {

/// Returns counts of a temperature that moves by `span_degc`, as a unit of this format sends them.
std::vector<std::int32_t> counts_of(const TemperatureFormat& format, double degc,
                                    double span_degc = 0.02) {
    // The shifted format has the resolution of the unshifted one.
    const bool is_shifted = std::abs(format.slope_degc) < 1e-6;
    const double step = is_shifted ? 65536.0 : 1.0;
    std::vector<std::int32_t> counts;
    for (int i = 0; i < 20; ++i) {
        const double at = degc + span_degc * i / 20.0;
        counts.push_back(static_cast<std::int32_t>(
            step * std::round((at - format.offset_degc) / (format.slope_degc * step))));
    }
    return counts;
}

}  // namespace

TEST_CASE("the counts of 42.5 degC read as published in the other formats", "[believable]") {
    const std::array<std::vector<std::int32_t>, 3> counts{
        std::vector{-1981}, std::vector{-129'826'816}, std::vector{43'520}};
    // Rows: the format of the unit; columns: that of the reader, degC.
    const std::array<std::array<double, 3>, 3> expected{
        {{42.4986, 34.9871, -1.9346}, {492312.4, 42.4986, -126784.0}, {-130.032, 34.9845, 42.5}}};
    for (std::size_t unit = 0; unit < 3; ++unit) {
        const auto candidates = temperature_candidates(counts[unit]);
        for (std::size_t reader = 0; reader < 3; ++reader)
            CHECK(candidates[reader].temperature.value() ==
                  Approx(expected[unit][reader]).epsilon(1e-4));
    }
}

TEST_CASE("at 42.5 degC the format of a unit is possible, and at most one other", "[believable]") {
    // Rows: the format of the unit; columns: that of the reader.
    const std::array<std::array<bool, 3>, 3> expected{
        {{true, false, true}, {false, true, false}, {false, false, true}}};
    for (std::size_t unit = 0; unit < 3; ++unit) {
        const auto candidates =
            temperature_candidates(counts_of(temperature_formats()[unit], 42.5));
        for (std::size_t reader = 0; reader < 3; ++reader)
            CHECK(candidates[reader].is_possible == expected[unit][reader]);
    }
}

TEST_CASE("a register without a value has no format", "[believable]") {
    for (const std::int32_t empty : {0, -1}) {
        const std::vector<std::int32_t> counts(20, empty);
        for (const TemperatureCandidate& one : temperature_candidates(counts))
            CHECK_FALSE(one.is_possible);
    }
}

TEST_CASE("the shipped profiles have the first format", "[believable]") {
    for (const std::string& name : wire::profile_names()) {
        CHECK(temperature_formats()[0].is_that_of(*wire::find_profile(name)));
        CHECK_FALSE(temperature_formats()[1].is_that_of(*wire::find_profile(name)));
        CHECK_FALSE(temperature_formats()[2].is_that_of(*wire::find_profile(name)));
    }
}

TEST_CASE("half, double and quarter scales are not a box at rest", "[believable]") {
    for (const double gravity_g : {0.997, 1.003}) {
        for (const double bias_g : {-0.05, 0.05})
            CHECK(is_norm_believable(StandardGravity(gravity_g + bias_g)));
        for (const double factor : {0.25, 0.5, 2.0, 4.0})
            CHECK_FALSE(is_norm_believable(StandardGravity(factor * gravity_g)));
    }
    CHECK_FALSE(is_norm_believable(StandardGravity(std::nan(""))));
}
