#include "corrector/noise/spectral_density.hpp"

#include <cstdio>
#include <numbers>

#include "tests/support/long_tests.hpp"
#include "tests/unit/noise/known_noise.hpp"

using namespace a351;
using namespace a351::corrector::noise;

namespace {

/// Returns the density at frequency k of segments of this length, by the definition.
double dense(const std::vector<double>& values, std::size_t length, std::size_t k) {
    long double power = 0.0L, sum = 0.0L;
    int segments = 0;
    for (std::size_t first = 0; first + length <= values.size(); first += length / 2, ++segments) {
        // The line by its normal equations about the middle.
        long double mean = 0.0L, slope = 0.0L, squares = 0.0L;
        const long double middle = 0.5L * static_cast<long double>(length - 1);
        for (std::size_t i = 0; i < length; ++i) {
            const long double t = static_cast<long double>(i) - middle;
            mean += values[first + i] / static_cast<long double>(length);
            slope += t * values[first + i];
            squares += t * t;
        }
        std::complex<long double> transform = 0.0L;
        power = 0.0L;
        for (std::size_t i = 0; i < length; ++i) {
            const long double t = static_cast<long double>(i) - middle;
            const long double w = 0.5L - 0.5L * std::cos(2.0L * std::numbers::pi_v<long double> *
                                                         static_cast<long double>(i) /
                                                         static_cast<long double>(length));
            power += w * w;
            transform += w * (values[first + i] - mean - slope / squares * t) *
                         std::polar(1.0L, -2.0L * std::numbers::pi_v<long double> *
                                              static_cast<long double>(k * i % length) /
                                              static_cast<long double>(length));
        }
        sum += std::norm(transform);
    }
    return static_cast<double>(2.0L * static_cast<long double>(kStep_s) * sum / power / segments);
}

}  // namespace

TEST_CASE("a spectral density equals its definition") {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        auto values = random_walk(720, 0.3, seed);
        const auto white = white_noise(720, 1.0, seed);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] += white[i];
        const auto found = spectral_density(values, kStep_s);
        REQUIRE(found.size() == 42);  // segments of 90
        for (std::size_t i = 0; i < found.size(); ++i) {
            CHECK(found[i].frequency_hz == Approx(static_cast<double>(i + 3) / (90 * kStep_s)));
            CHECK(found[i].mgal2_per_hz.value == Approx(dense(values, 90, i + 3)).epsilon(1e-9));
        }
    }
}

TEST_CASE("the density of several stays has no segment that reaches from one to the next") {
    constexpr std::size_t kLength = 90;
    std::vector<std::vector<double>> stays;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        stays.push_back(white_noise(200, 1.0, seed));
        for (double& value : stays.back()) value += 1000.0 * static_cast<double>(seed * seed);
    }
    stays.push_back(white_noise(kLength - 1, 1e6, 9));  // too short for a segment
    const auto pooled = pooled_density(stays, kStep_s, kLength);
    for (std::size_t i = 0; i < pooled.size(); ++i) {
        double mean = 0.0;
        for (std::size_t k = 0; k < 4; ++k) mean += dense(stays[k], kLength, i + 3) / 4.0;
        CHECK(pooled[i].mgal2_per_hz.value == Approx(mean).epsilon(1e-9));
    }
    CHECK(pooled_density({stays.back()}, kStep_s, kLength).empty());
}

TEST_CASE("limits of the density of several stays contain it") {
    constexpr int kDays = 200;
    int inside = 0, all = 0;
    for (std::uint64_t day = 0; day < kDays; ++day) {
        std::vector<std::vector<double>> stays;
        for (std::uint64_t stay = 0; stay < 10; ++stay)
            stays.push_back(white_noise(300, 2.0, 100 * day + stay));
        for (const Density& one : pooled_density(stays, kStep_s, 120)) {
            ++all;
            inside +=
                one.mgal2_per_hz.low <= 8.0 * kStep_s && 8.0 * kStep_s <= one.mgal2_per_hz.high ? 1
                                                                                                : 0;
        }
    }
    std::printf("pooled stays: %.4f\n", static_cast<double>(inside) / all);
    CHECK(std::abs(static_cast<double>(inside) / all - 0.95) < 0.01);
}

TEST_CASE("a spectrogram shows when and at which frequency a signal is") {
    auto values = white_noise(6 * 180, 0.1, 3);  // 6 h
    for (std::size_t i = 540; i < values.size(); ++i)
        values[i] += std::sin(2.0 * std::numbers::pi * 0.005 * static_cast<double>(i) * kStep_s);
    const auto tiles = spectrogram(values, kStep_s);
    CHECK(tiles.front().start_s == 1800.0);
    CHECK(tiles.back().end_s == 5.5 * 3600.0);
    double most_early = 0.0;
    const Tile* most_late = nullptr;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        const Tile& tile = tiles[i];
        const bool continues = i > 0 && tiles[i - 1].start_s == tile.start_s;
        if (continues) CHECK(tile.low_hz == Approx(tiles[i - 1].high_hz));
        if (tile.end_s <= 2.5 * 3600.0) most_early = std::max(most_early, tile.mgal2_per_hz);
        if (tile.start_s >= 3.5 * 3600.0 &&
            (most_late == nullptr || tile.mgal2_per_hz > most_late->mgal2_per_hz))
            most_late = &tile;
    }
    CHECK(most_early < 4.0 * 2.0 * 0.01 * kStep_s);
    REQUIRE(most_late != nullptr);
    CHECK(most_late->low_hz < 0.005);
    CHECK(most_late->high_hz > 0.005);
    CHECK(most_late->mgal2_per_hz > 100.0);
    CHECK(spectrogram(white_noise(350, 1.0, 1), kStep_s).empty());
}

TEST_CASE("the limits contain the density of known noise") {
    constexpr std::size_t kCount = 1024;
    const int records = test::is_long() ? 2000 : 500;
    std::vector<int> inside;
    for (int record = 0; record < records; ++record) {
        const auto found =
            spectral_density(white_noise(kCount, 2.0, static_cast<std::uint64_t>(record)), kStep_s);
        inside.resize(found.size());
        for (std::size_t i = 0; i < found.size(); ++i)
            inside[i] += found[i].mgal2_per_hz.low <= 2.0 * 4.0 * kStep_s &&
                                 2.0 * 4.0 * kStep_s <= found[i].mgal2_per_hz.high
                             ? 1
                             : 0;
    }
    double all = 0.0;
    for (const int count : inside) {
        CHECK(count >= 0.91 * records);
        CHECK(count <= 0.98 * records);
        all += count;
    }
    all /= static_cast<double>(records) * static_cast<double>(inside.size());
    std::printf("limits of %zu frequencies contain the density: %.4f; least %.3f, most %.3f\n",
                inside.size(), all,
                *std::ranges::min_element(inside) / static_cast<double>(records),
                *std::ranges::max_element(inside) / static_cast<double>(records));
    CHECK(std::abs(all - 0.95) < 0.01);
}
