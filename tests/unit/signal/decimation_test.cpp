#include "protocol/signal/decimation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include "tests/support/catch.hpp"

namespace a351::signal {
namespace {

/// Returns the gain at `frequency`, a fraction of the input rate.
double gain(const DecimationFilter& filter, double frequency) {
    double sum = 0.0;
    const double half = static_cast<double>(filter.half_width());
    for (std::size_t n = 0; n < filter.taps.size(); ++n) {
        sum += filter.taps[n] *
               std::cos(2.0 * std::numbers::pi * frequency * (static_cast<double>(n) - half));
    }
    return std::abs(sum);
}

double decibel(double ratio) { return 20.0 * std::log10(ratio); }

}  // namespace

TEST_CASE("a ramp is not delayed by decimation") {
    std::vector<double> ramp(5000);
    for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = 0.25 * static_cast<double>(i) - 3.0;
    const UtcTime start{std::chrono::seconds(1'500'000'000)};
    const TimeSeries<MilliGal> series(start, Hertz(50.0), ramp);
    const auto output = decimate(series, design_decimation(10), 2);
    CHECK(output.rate().value() == Approx(0.5));
    CHECK(output.size() == 50);
    for (std::size_t k = 0; k < output.size(); ++k) {
        const double seconds = seconds_between(start, output.time_of(static_cast<double>(k)));
        if (!std::isnan(output.values()[k])) {
            CHECK(output.values()[k] == Approx(0.25 * 50.0 * seconds - 3.0).epsilon(1e-13));
        }
    }
    CHECK_FALSE(std::isnan(output.values()[25]));
}

TEST_CASE("the filter of factor ten has the gains of its design") {
    // An 83-tap Hamming-windowed sinc with cut-off 0.05, to 3 decimals; any filter design program
    // gives these values.
    const DecimationFilter filter = design_decimation(10);
    CHECK(filter.taps.size() == 83);
    for (const int factor : {2, 5, 10, 25}) {  // A constant is unchanged.
        const auto output = decimate(std::vector(2000, 980'665.25), design_decimation(factor));
        CHECK(output.at(output.size() / 2) == Approx(980'665.25).epsilon(1e-14));
    }
    CHECK(decibel(gain(filter, 0.01)) == Approx(0.03).margin(0.005));
    CHECK(decibel(gain(filter, 0.03)) == Approx(-0.003).margin(0.0005));
    CHECK(decibel(gain(filter, 0.04)) == Approx(-1.2).margin(0.05));
    CHECK(decibel(gain(filter, 0.05)) == Approx(-6.0).margin(0.05));
    CHECK(decibel(gain(filter, 0.06)) == Approx(-17.9).margin(0.05));
    CHECK(decibel(gain(filter, 0.07)) == Approx(-53.0).margin(0.5));
    for (double frequency = 0.07; frequency <= 0.5; frequency += 0.0005) {
        CHECK(decibel(gain(filter, frequency)) < -52.4);
    }
    double noise_power = 0.0;
    for (const double tap : filter.taps) noise_power += tap * tap;
    CHECK(noise_power == Approx(0.0909).margin(0.00005));
}

TEST_CASE("twenty minutes at 50 Hz give 600 samples of which number 5 to 595 are valid") {
    const TimeSeries<MilliGal> series(UtcTime{}, Hertz(50.0), std::vector<double>(60'000, 1.0));
    const auto output = decimate(series, design_decimation(10), 2);
    REQUIRE(output.size() == 600);
    for (std::size_t k = 0; k < 600; ++k) {
        CHECK(std::isnan(output.values()[k]) == (k < 5 || k > 595));
    }
}

TEST_CASE("the minimum length is the shortest that gives a valid output") {
    for (const int factor : {2, 7, 10, 33}) {
        for (const int stages : {1, 2, 3}) {
            CAPTURE(factor, stages);
            const DecimationFilter filter = design_decimation(factor);
            const auto has_valid = [&](double n) {
                const std::vector<double> ones(static_cast<std::size_t>(n), 1.0);
                const TimeSeries<MilliGal> series(UtcTime{}, Hertz(1.0), ones);
                const auto output = decimate(series, filter, stages);
                return !std::ranges::all_of(output.values(),
                                            [](double v) { return std::isnan(v); });
            };
            CHECK(has_valid(least_length(filter, stages)));
            CHECK_FALSE(has_valid(least_length(filter, stages) - 1.0));
        }
    }
    CHECK(least_length(design_decimation(10), 2) == 952.0);
}

TEST_CASE("a factor outside 2 to 1000 is refused") {
    for (const int factor : {-1, 0, 1, 1001}) {
        CHECK_THROWS_AS(design_decimation(factor), std::invalid_argument);
    }
}

}  // namespace a351::signal
