#include "corrector/long_record/record_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sim/noise/random.hpp"
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::long_record;

namespace {

constexpr std::size_t kCount = 20'000;
constexpr double kStep_s = 20.0;

std::vector<double> white_noise(double sd_mgal, std::uint64_t seed) {
    sim::noise::RandomStream stream(seed, "white");
    std::vector<double> values(kCount);
    for (double& value : values) value = 979800.0 + sd_mgal * stream.normal();
    return values;
}

std::vector<double> walk(double per_step_mgal, std::uint64_t seed) {
    sim::noise::RandomStream stream(seed, "walk");
    std::vector<double> values(kCount);
    double sum = 0.0;
    for (double& value : values) value = sum += per_step_mgal * stream.normal();
    return values;
}

void print(const char* name, const RecordNoise& noise) {
    std::printf(
        "%s: white %.4f mGal s^0.5, flicker %.4f mGal, walk %.6f mGal/s^0.5, useful %.0f s\n", name,
        noise.white_mgal_sqrt_s, noise.flicker_mgal, noise.walk_mgal_per_sqrt_s,
        noise.useful.value().averaging_s);
}

}  // namespace

TEST_CASE("white noise has its level in spectrum, Allan deviation and model", "[long_record]") {
    const RecordNoise noise = record_noise(white_noise(2.0, 1), kStep_s);
    print("white", noise);
    CHECK(noise.white_mgal_sqrt_s == Approx(2.0 * std::sqrt(kStep_s)).epsilon(0.03));
    CHECK(noise.flicker_mgal < 0.03 * 2.0);
    CHECK(noise.walk_mgal_per_sqrt_s * std::sqrt(kStep_s) < 0.03 * 2.0);
    CHECK(noise.allan.front().deviation_mgal == Approx(2.0).epsilon(0.03));
    // One-sided density 2 sd^2 step.  A band of the shortest periods has thousands of frequencies.
    REQUIRE(noise.spectrum.size() > 10);
    for (std::size_t i = 0; i < 10; ++i)
        CHECK(noise.spectrum[i].density_mgal2_per_hz == Approx(2.0 * 4.0 * kStep_s).epsilon(0.2));
    CHECK(noise.spectrum.front().period_s < 1.2 * 2.0 * kStep_s);
    CHECK(noise.spectrum.front().period_s < noise.spectrum.back().period_s);
}

TEST_CASE("a random walk has its level, and a longer stay hardly helps against it",
          "[long_record]") {
    const RecordNoise noise = record_noise(walk(0.1, 2), kStep_s);
    print("walk", noise);
    CHECK(noise.walk_mgal_per_sqrt_s == Approx(0.1 / std::sqrt(kStep_s)).epsilon(0.15));
    CHECK(noise.stays.front().scatter_mgal < 1.3 * noise.useful->scatter_mgal);
}

TEST_CASE("a stay as long as the cycle of the oven is useful, a shorter one is not",
          "[long_record]") {
    std::vector<double> values = white_noise(0.1, 3);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] += 3.0 * std::sin(2.0 * 3.14159265 * static_cast<double>(i) * kStep_s / 1000.0);
    const RecordNoise noise = record_noise(values, kStep_s);
    print("cycle", noise);
    // Averages over half the cycle keep 2 / pi of it; those 3.6 cycles apart differ.
    CHECK(noise.useful->averaging_s >= 1000.0 / 2.0);
    CHECK(noise.stays.front().scatter_mgal > 5.0 * noise.useful->scatter_mgal);
}

TEST_CASE("white noise asks for the longest stay, and a short record for none", "[long_record]") {
    const std::vector<double> values = white_noise(2.0, 5);
    const RecordNoise noise = record_noise(values, kStep_s);
    CHECK(noise.useful->averaging_s == noise.stays.back().averaging_s);
    CHECK(noise.useful->scatter_mgal == Approx(2.0 / std::sqrt(128.0)).epsilon(0.1));
    CHECK_FALSE(record_noise({values.begin(), values.begin() + 539}, kStep_s).useful);
}
