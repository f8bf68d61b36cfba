
#include <array>
#include "tests/support/catch.hpp"

#include "tests/support/white_noise.hpp"
#include "tests/unit/eemd/series.hpp"

namespace a351::corrector::eemd {
namespace {

using Words = std::array<std::uint32_t, 4>;

std::uint32_t low_word(std::uint64_t value) { return static_cast<std::uint32_t>(value); }
std::uint32_t high_word(std::uint64_t value) { return static_cast<std::uint32_t>(value >> 32); }

/// Returns four random words of 32 bits for each counter and key, by Philox 4x32-10.
Words philox(Words counter, std::array<std::uint32_t, 2> key) {
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t p0 = std::uint64_t{0xD2511F53} * counter[0];
        const std::uint64_t p1 = std::uint64_t{0xCD9E8D57} * counter[2];
        counter = {high_word(p1) ^ counter[1] ^ key[0], low_word(p1),
                   high_word(p0) ^ counter[3] ^ key[1], low_word(p0)};
        key = {key[0] + 0x9E3779B9U, key[1] + 0xBB67AE85U};
    }
    return counter;
}

}  // namespace

TEST_CASE("Philox 4x32-10 gives the published words") {
    // Known answers of the authors' library Random123, file kat_vectors.
    CHECK(philox({0, 0, 0, 0}, {0, 0}) == Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
    CHECK(philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}) ==
          Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
    CHECK(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
          Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("noise is the Box-Muller transform of the generator's words") {
    std::vector<double> noise(2000);
    fill_white_noise(5, 9, noise);
    const auto uniform = [](std::uint32_t low, std::uint32_t high) {
        return static_cast<double>(((std::uint64_t{high} << 32) | low) >> 11);
    };
    for (std::uint32_t pair = 0; pair < 1000; ++pair) {
        const auto w = philox({pair, 0, 9, 0}, {5, 0});
        const double radius = std::sqrt(-2.0 * std::log((uniform(w[0], w[1]) + 1.0) * 0x1p-53));
        const double angle = 2.0 * std::numbers::pi * (uniform(w[2], w[3]) * 0x1p-53);
        CHECK(noise[2 * pair] == Approx(radius * std::cos(angle)).epsilon(1e-13).margin(1e-14));
        CHECK(noise[2 * pair + 1] == Approx(radius * std::sin(angle)).epsilon(1e-13).margin(1e-14));
    }
}

TEST_CASE("noise has mean 0, variance 1, fourth moment 3 and no correlation between neighbours") {
    const std::size_t n = 1'000'000;
    const std::vector<double> w = white_noise(n, 1);
    double mean = 0.0, square = 0.0, fourth = 0.0, neighbour = 0.0, next_pair = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        mean += w[i];
        square += w[i] * w[i];
        fourth += w[i] * w[i] * w[i] * w[i];
        if (i >= 1) neighbour += w[i] * w[i - 1];
        if (i >= 2) next_pair += w[i] * w[i - 2];
    }
    const double sigma = 1.0 / std::sqrt(static_cast<double>(n));  // four of them allowed
    const double count = static_cast<double>(n);
    CHECK(std::abs(mean / count) < 4 * sigma);
    CHECK(std::abs(square / count - 1.0) < 4 * std::sqrt(2.0) * sigma);
    CHECK(std::abs(fourth / count - 3.0) < 4 * std::sqrt(96.0) * sigma);
    CHECK(std::abs(neighbour / count) < 4 * sigma);
    CHECK(std::abs(next_pair / count) < 4 * sigma);
}

TEST_CASE("a longer series of noise begins with the shorter one") {
    const auto longer = white_noise(101, 4);
    auto shorter = white_noise(50, 4);
    CHECK(std::equal(shorter.begin(), shorter.end(), longer.begin()));
}

}  // namespace a351::corrector::eemd
