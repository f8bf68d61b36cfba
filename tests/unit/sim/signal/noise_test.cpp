#include "sim/noise/noise.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>
#include "tests/support/catch.hpp"

#include "sim/signal/signal_source.hpp"

using namespace a351;
using namespace a351::sim::noise;
using namespace a351::sim::signal;

namespace {

double rms(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value * value;
    return std::sqrt(sum / static_cast<double>(values.size()));
}

/// Returns the power of one periodogram ordinate; frequency in cycles per step.
double power(const std::vector<double>& values, double frequency) {
    const std::complex<double> step = std::polar(1.0, -2.0 * std::numbers::pi * frequency);
    std::complex<double> phase = 1.0, sum = 0.0;
    for (const double value : values) {
        sum += value * phase;
        phase *= step;
    }
    return std::norm(sum) / static_cast<double>(values.size());
}

/// Returns the mean power over neighbouring frequencies, which are nearly independent.
double mean_power(const std::vector<double>& values, double low, double high, int points) {
    double sum = 0.0;
    for (int i = 0; i < points; ++i) {
        sum += power(values, low + (high - low) * (i + 0.5) / points);
    }
    return sum / points;
}

}  // namespace

TEST_CASE("flicker noise has the requested rms and falls by 3 dB per octave") {
    FlickerNoise noise(RandomStream(2, "flicker"), 1.5, 40.0, 4000.0, 1.0);
    std::vector<double> values(200'000);
    for (double& value : values) value = noise.next();
    // The longest part has some 300 independent stretches in this record.
    CHECK(rms(values) == Approx(1.5).epsilon(0.1));
    const double slow = mean_power(values, 0.9e-3, 1.1e-3, 40);
    const double fast = mean_power(values, 7.2e-3, 8.8e-3, 320);
    // 1/f: a factor of 8 over three octaves; the sum of processes ripples by some 10 %.
    CHECK(slow / fast == Approx(8.0).epsilon(0.35));
}

TEST_CASE("resonant noise has the requested rms and its power around the centre") {
    ResonantNoise noise(RandomStream(2, "resonant"), 1.4, 900.0, 2.0, 1.0);
    std::vector<double> values(400'000);
    for (double& value : values) value = noise.next();
    CHECK(rms(values) == Approx(1.4).epsilon(0.1));
    // Power of a damped oscillator of this Q: 1 / ((1 - x^2)^2 + (x / Q)^2), x = 900 s / period.
    // Means of some 50 ordinates scatter by 15 to 25 %.
    const auto power_at = [&](double x) {
        return mean_power(values, 0.95 * x / 900.0, 1.05 * x / 900.0,
                          static_cast<int>(40 * x) + 20);
    };
    const double centre = power_at(1.0);
    CHECK(centre / power_at(0.35) == Approx(4.0 / 1.249).epsilon(0.6));
    CHECK(centre / power_at(2.6) == Approx(4.0 * 34.9).epsilon(0.4));
}

TEST_CASE("a noise of zero rms is zero") {
    FlickerNoise flicker(RandomStream(2, "flicker"), 0.0, 40.0, 36000.0, 1.0);
    ResonantNoise resonant(RandomStream(2, "resonant"), 0.0, 900.0, 2.0, 1.0);
    for (int i = 0; i < 100; ++i) {
        CHECK(flicker.next() == 0.0);
        CHECK(resonant.next() == 0.0);
    }
}

TEST_CASE("ground noise has the requested rms and hardly changes minute means") {
    BandNoise noise(20.0, 1.0, 20.0, 50.0);
    RandomStream stream(5, "ground");
    std::vector<double> values(300'000);
    for (double& value : values) value = noise.next(stream.normal());
    CHECK(rms(values) == Approx(20.0).epsilon(0.02));
    double largest_mean = 0.0;
    for (std::size_t minute = 0; minute < values.size() / 3000; ++minute) {
        double sum = 0.0;
        for (std::size_t i = 0; i < 3000; ++i) sum += values[minute * 3000 + i];
        largest_mean = std::max(largest_mean, std::abs(sum / 3000.0));
    }
    CHECK(largest_mean < 0.1);  // White noise of 20 mGal would reach 1 mGal.
}

TEST_CASE("the same seed and name give the same draws, another seed or name gives others") {
    RandomStream first(7, "ground"), again(7, "ground"), other_seed(8, "ground"),
        other_name(7, "white");
    int equal_to_other = 0;
    for (int i = 0; i < 1000; ++i) {
        const std::uint64_t draw = first.bits();
        REQUIRE(draw == again.bits());
        equal_to_other += draw == other_seed.bits() ? 1 : 0;
        equal_to_other += draw == other_name.bits() ? 1 : 0;
    }
    CHECK(equal_to_other == 0);
}

TEST_CASE("the quantile inverts the normal distribution function in all its branches") {
    for (const double p :
         {1e-300, 1e-20, 1e-12, 1e-6, 0.01, 0.07, 0.3, 0.5, 0.92, 0.99, 0.999999}) {
        const double x = normal_quantile(p);
        // erfc is Phi to full precision: Phi(x) = erfc(-x / sqrt 2) / 2.  A relative error d of x
        // causes a relative error of p of up to x^2 d.
        CHECK(0.5 * std::erfc(-x / std::sqrt(2.0)) ==
              Approx(p).epsilon(1e-14 * (1.0 + x * x)).margin(0.0));
    }
}

TEST_CASE("normal draws have the moments of the normal distribution and no correlation") {
    constexpr int kCount = 1'000'000;
    RandomStream stream(1, "moments");
    double sum = 0.0, square = 0.0, fourth = 0.0, product = 0.0, before = 0.0;
    for (int i = 0; i < kCount; ++i) {
        const double x = stream.normal();
        sum += x;
        square += x * x;
        fourth += x * x * x * x;
        product += x * before;
        before = x;
    }
    // Five standard errors of each estimate.
    const double error = 5.0 / std::sqrt(kCount);
    CHECK(std::abs(sum / kCount) < error);
    CHECK(std::abs(square / kCount - 1.0) < error * std::sqrt(2.0));
    CHECK(std::abs(fourth / kCount - 3.0) < error * std::sqrt(96.0));
    CHECK(std::abs(product / kCount) < error);
}

TEST_CASE("exponential draws have the mean waiting time of a Poisson event") {
    constexpr int kCount = 100'000;
    RandomStream stream(3, "waits");
    double sum = 0.0;
    for (int i = 0; i < kCount; ++i) sum += stream.exponential();
    CHECK(std::abs(sum / kCount - 1.0) < 5.0 / std::sqrt(kCount));
}
