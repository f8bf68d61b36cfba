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

TEST_CASE("flicker noise has the requested rms and falls by 3 dB per octave", "[sim][noise]") {
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

TEST_CASE("resonant noise has the requested rms and its power around the centre", "[sim][noise]") {
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

TEST_CASE("a noise of zero rms is zero", "[sim][noise]") {
    FlickerNoise flicker(RandomStream(2, "flicker"), 0.0, 40.0, 36000.0, 1.0);
    ResonantNoise resonant(RandomStream(2, "resonant"), 0.0, 900.0, 2.0, 1.0);
    for (int i = 0; i < 100; ++i) {
        CHECK(flicker.next() == 0.0);
        CHECK(resonant.next() == 0.0);
    }
}

TEST_CASE("ground noise has the requested rms and hardly changes minute means", "[sim][noise]") {
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
