#include "protocol/signal/decimation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include "tests/support/catch.hpp"

namespace a351::signal {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

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

TEST_CASE("a constant is unchanged wherever the output is valid") {
    for (const int factor : {2, 5, 10, 25}) {
        const auto output =
            decimate(std::vector<double>(2000, 980'665.25), design_decimation(factor));
        std::size_t valid = 0;
        for (const double value : output) {
            if (std::isnan(value)) continue;
            ++valid;
            CHECK(std::abs(value / 980'665.25 - 1.0) <= 1e-14);
        }
        CHECK(valid > 0);
    }
}

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

TEST_CASE("a series reversed in time decimates to the reversed values, bit for bit") {
    std::vector<double> forward(1001);
    for (std::size_t i = 0; i < forward.size(); ++i) {
        forward[i] = std::sin(0.01 * static_cast<double>(i * i % 977));
    }
    const std::vector<double> backward(forward.rbegin(), forward.rend());
    const auto a = decimate(forward, design_decimation(10));
    const auto b = decimate(backward, design_decimation(10));
    REQUIRE(a.size() == 101);
    for (std::size_t k = 5; k <= 95; ++k) CHECK(a[k] == b[100 - k]);
}

TEST_CASE("the filter of factor ten has the gains of its design") {
    // An 83-tap Hamming-windowed sinc with cut-off 0.05, to 3 decimals; any filter design program
    // gives these values.
    const DecimationFilter filter = design_decimation(10);
    CHECK(filter.taps.size() == 83);
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

TEST_CASE("a tone gets the filter's gain and keeps its phase") {
    const DecimationFilter filter = design_decimation(10);
    for (const double frequency : {0.003, 0.02, 0.04, 0.045}) {
        std::vector<double> tone(4000);
        for (std::size_t i = 0; i < tone.size(); ++i) {
            tone[i] = std::cos(2.0 * std::numbers::pi * frequency * static_cast<double>(i));
        }
        const auto output = decimate(tone, filter);
        for (std::size_t k = 5; k < 395; ++k) {
            REQUIRE(output[k] == Approx(gain(filter, frequency) * tone[10 * k]).margin(1e-12));
        }
    }
}

TEST_CASE("twenty minutes at 50 Hz give 600 samples of which number 5 to 595 are valid") {
    const TimeSeries<MilliGal> series(UtcTime{}, Hertz(50.0), std::vector<double>(60'000, 1.0));
    const auto output = decimate(series, design_decimation(10), 2);
    REQUIRE(output.size() == 600);
    for (std::size_t k = 0; k < 600; ++k) {
        CHECK(std::isnan(output.values()[k]) == (k < 5 || k > 595));
    }
}

TEST_CASE("one missing sample invalidates only the outputs whose filter includes it") {
    const std::size_t gap = GENERATE(200U, 201U, 205U, 241U, 999U);
    std::vector<double> input(1000, 2.0);
    input[gap] = kNan;
    const auto output = decimate(input, design_decimation(10));
    for (std::size_t k = 0; k < output.size(); ++k) {
        const std::size_t centre = 10 * k;
        const bool reaches_beyond = centre < 41 || centre + 41 > 999;
        const bool touches_gap = centre <= gap + 41 && gap <= centre + 41;
        CHECK(std::isnan(output[k]) == (reaches_beyond || touches_gap));
    }
}

TEST_CASE("an infinite sample counts as missing") {
    std::vector<double> input(200, 2.0);
    input[100] = std::numeric_limits<double>::infinity();
    CHECK(std::isnan(decimate(input, design_decimation(10))[10]));
}

TEST_CASE(
    "each started block of input gives one output, and all outputs are missing if the input is too "
    "short") {
    const DecimationFilter filter = design_decimation(10);
    for (std::size_t n = 0; n <= 90; ++n) {
        const auto output = decimate(std::vector<double>(n, 1.0), filter);
        CHECK(output.size() == (n + 9) / 10);
        for (std::size_t k = 0; k < output.size(); ++k) {
            CHECK(std::isnan(output[k]) == (10 * k < 41 || 10 * k + 41 >= n));
        }
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
                const auto& values = output.values();
                return std::any_of(values.begin(), values.end(),
                                   [](double value) { return !std::isnan(value); });
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
