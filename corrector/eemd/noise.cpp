#include "corrector/eemd/noise.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace a351::corrector {
namespace {

std::uint32_t low_word(std::uint64_t value) { return static_cast<std::uint32_t>(value); }
std::uint32_t high_word(std::uint64_t value) { return static_cast<std::uint32_t>(value >> 32); }

/// 53 bits of two words, 0 ... 2^53 - 1.
double upper_bits(std::uint32_t low, std::uint32_t high) {
    return static_cast<double>(((std::uint64_t{high} << 32) | low) >> 11);
}

/// ln(u) for 0 < u <= 1, to 2 units in the last place: ln m = 2 artanh((m - 1) / (m + 1)).
double natural_log(double u) {
    int exponent = 0;
    double m = std::frexp(u, &exponent);
    if (m < 0.5 * std::numbers::sqrt2) {
        m *= 2.0;
        --exponent;
    }
    const double s = (m - 1.0) / (m + 1.0);  // |s| <= 0.172, so the terms fall below 2^-53 at s^21
    const double s2 = s * s;
    double series = 0.0;
    for (int k = 21; k >= 1; k -= 2) series = series * s2 + 1.0 / k;
    return exponent * std::numbers::ln2 + 2.0 * s * series;
}

/// (cos, sin) of `turn` full turns, 0 <= turn < 1, by Taylor series within an eighth of a turn.
std::pair<double, double> cos_sin(double turn) {
    const double quarters = std::floor(4.0 * turn);
    const double within = 4.0 * turn - quarters;
    const bool mirrored = within > 0.5;
    const double angle = 0.5 * std::numbers::pi * (mirrored ? 1.0 - within : within);
    const double a2 = angle * angle;
    double cosine = 1.0;
    double sine = 1.0;
    for (int k = 16; k >= 2; k -= 2) {
        cosine = 1.0 - a2 / ((k - 1) * k) * cosine;
        sine = 1.0 - a2 / (k * (k + 1)) * sine;
    }
    sine *= angle;
    if (mirrored) std::swap(cosine, sine);
    switch (static_cast<int>(quarters)) {
        case 0:
            return {cosine, sine};
        case 1:
            return {-sine, cosine};
        case 2:
            return {-cosine, -sine};
        default:
            return {sine, -cosine};
    }
}

}  // namespace

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                    std::array<std::uint32_t, 2> key) noexcept {
    constexpr std::uint64_t kMultiplier0 = 0xD2511F53;
    constexpr std::uint64_t kMultiplier1 = 0xCD9E8D57;
    constexpr std::uint32_t kWeyl0 = 0x9E3779B9;
    constexpr std::uint32_t kWeyl1 = 0xBB67AE85;
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t p0 = kMultiplier0 * counter[0];
        const std::uint64_t p1 = kMultiplier1 * counter[2];
        counter = {high_word(p1) ^ counter[1] ^ key[0], low_word(p1),
                   high_word(p0) ^ counter[3] ^ key[1], low_word(p0)};
        key = {key[0] + kWeyl0, key[1] + kWeyl1};
    }
    return counter;
}

void fill_white_noise(std::uint64_t seed, std::uint64_t member, std::span<double> noise) noexcept {
    for (std::size_t i = 0; i < noise.size(); i += 2) {
        const std::uint64_t pair = i / 2;
        const auto word =
            philox({low_word(pair), high_word(pair), low_word(member), high_word(member)},
                   {low_word(seed), high_word(seed)});
        constexpr double kUnit = 0x1p-53;
        const double radius =
            std::sqrt(-2.0 * natural_log((upper_bits(word[0], word[1]) + 1.0) * kUnit));
        const auto [cosine, sine] = cos_sin(upper_bits(word[2], word[3]) * kUnit);
        noise[i] = radius * cosine;
        if (i + 1 < noise.size()) noise[i + 1] = radius * sine;
    }
}

}  // namespace a351::corrector
