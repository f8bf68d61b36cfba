#include "corrector/noise/record_noise.hpp"

#include "tests/unit/noise/known_noise.hpp"

using namespace a351;
using namespace a351::corrector::noise;

namespace {

constexpr std::size_t kCount = 20'000;

}  // namespace

TEST_CASE("a longer stay hardly helps against a random walk") {
    const RecordNoise noise = record_noise(random_walk(kCount, 0.1, 2), kStep_s);
    CHECK(noise.stays.front().scatter_mgal < 1.3 * noise.useful->scatter_mgal);
}

TEST_CASE("a stay as long as the cycle of the oven is useful, a shorter one is not") {
    std::vector<double> values = white_noise(kCount, 0.1, 3);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] += 3.0 * std::sin(2.0 * 3.14159265 * static_cast<double>(i) * kStep_s / 1000.0);
    const RecordNoise noise = record_noise(values, kStep_s);
    // Averages over half the cycle keep 2 / pi of it; those 3.6 cycles apart differ.
    CHECK(noise.useful->averaging_s >= 1000.0 / 2.0);
    CHECK(noise.stays.front().scatter_mgal > 5.0 * noise.useful->scatter_mgal);
}

TEST_CASE("white noise asks for the longest stay, and a short record for none") {
    const std::vector<double> values = white_noise(kCount, 2.0, 5);
    const RecordNoise noise = record_noise(values, kStep_s);
    CHECK(noise.useful->averaging_s == noise.stays.back().averaging_s);
    CHECK(noise.useful->scatter_mgal == Approx(2.0 / std::sqrt(128.0)).epsilon(0.1));
    CHECK_FALSE(record_noise({values.begin(), values.begin() + 539}, kStep_s).useful);
}
