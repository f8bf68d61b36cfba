#pragma once
/// @file
/// White Gaussian noise in plain loops over blocks, compiled once for every instruction set.  The
/// rules are in sift_kernels.hpp, the formula is there too.
///
/// Only additions, multiplications, divisions and roots of doubles are used, which IEEE 754 rounds
/// exactly, and operations on integers.  The logarithm and the sine are series, written out below.
/// Hence no mathematical library can change a bit.
///
/// Call fill_noise() through SiftKernels::fill_white_noise; the other functions are its parts.

#include <cstddef>
#include <cstdint>

#include "corrector/eemd/lanes.hpp"

namespace a351::corrector::eemd {
namespace {

/// Pairs of samples per block.  Reason: the buffers fit into the first-level cache.
constexpr std::size_t kNoiseBlock = 64;

/// Returns the 64 bits of a double.
inline std::uint64_t bits_of(double value) { return __builtin_bit_cast(std::uint64_t, value); }
/// Returns the double with these bits; the inverse of bits_of().
inline double double_of(std::uint64_t bits) { return __builtin_bit_cast(double, bits); }

/// Returns an integer below 2^52 as a double, from the bits of 2^52 + value.
/// It is exact.  A cast would do the same, but AVX2 has no instruction for it, so that the loop
/// would not become vectors.
inline double small_integer(std::uint64_t value) {
    return double_of(bits_of(0x1p52) | value) - 0x1p52;
}

/// Returns the upper 53 bits of two words, 0 ... 2^53 - 1.
/// The result is exact.
/// @param low, high  words of 32 bits, each in 64 bits.
inline double upper_bits(std::uint64_t low, std::uint64_t high) {
    return small_integer(high) * 0x1p21 + small_integer(low >> 11);
}

/// Returns ln(u) for 2^-53 <= u <= 1, within 2 units in the last place, by
/// ln m = 2 artanh((m - 1) / (m + 1)).
///
/// The argument is split into m 2^k with 0.7 < m < 1.42, and the result is k ln 2 + ln m.  Other
/// arguments (0, negative, NaN) give a meaningless number.  ln(1) is exactly 0.
inline double natural_log(double u) {
    constexpr std::uint64_t kMantissa = 0x000FFFFFFFFFFFFF;
    const double half = double_of((bits_of(u) & kMantissa) | bits_of(0.5));  // 0.5 <= half < 1
    const double exponent = small_integer(bits_of(u) >> 52) - 1022.0;
    const bool low = half < 0.5 * 1.4142135623730951;
    const double m = low ? 2.0 * half : half;
    const double s = (m - 1.0) / (m + 1.0);  // |s| <= 0.172, so terms are below 2^-53 from s^21 on
    const double s2 = s * s;
    double series = 1.0 / 21;
    series = series * s2 + 1.0 / 19;
    series = series * s2 + 1.0 / 17;
    series = series * s2 + 1.0 / 15;
    series = series * s2 + 1.0 / 13;
    series = series * s2 + 1.0 / 11;
    series = series * s2 + 1.0 / 9;
    series = series * s2 + 1.0 / 7;
    series = series * s2 + 1.0 / 5;
    series = series * s2 + 1.0 / 3;
    series = series * s2 + 1.0;
    return (low ? exponent - 1.0 : exponent) * 0.6931471805599453 + 2.0 * s * series;
}

/// Fills w0 ... w3 with the words of one block's counters, by Philox 4x32-10.
///
/// @param first_pair  number of the first pair of samples, a multiple of kNoiseBlock.
/// @param member  upper half of the counter.
/// @param seed  key of the generator.
/// @param w0, w1, w2, w3  receive kNoiseBlock words each, one per pair of samples.
/// Source of the constants: J. K. Salmon et al., SC11, 2011 (sift_kernels.hpp).
inline void philox_block(std::uint64_t first_pair, std::uint64_t member, std::uint64_t seed,
                         std::uint32_t* w0, std::uint32_t* w1, std::uint32_t* w2,
                         std::uint32_t* w3) {
    // Blocks begin at multiples of their length, so the upper word is the same for all of one.
    const auto first = static_cast<std::uint32_t>(first_pair);
    const auto upper = static_cast<std::uint32_t>(first_pair >> 32);
    A351_INDEPENDENT
    for (std::uint32_t i = 0; i < kNoiseBlock; ++i) {
        std::uint32_t c0 = first + i;
        std::uint32_t c1 = upper;
        std::uint32_t c2 = static_cast<std::uint32_t>(member);
        std::uint32_t c3 = static_cast<std::uint32_t>(member >> 32);
        std::uint32_t k0 = static_cast<std::uint32_t>(seed);
        std::uint32_t k1 = static_cast<std::uint32_t>(seed >> 32);
        for (int round = 0; round < 10; ++round) {
            const auto high0 = static_cast<std::uint32_t>((std::uint64_t{0xD2511F53} * c0) >> 32);
            const auto high1 = static_cast<std::uint32_t>((std::uint64_t{0xCD9E8D57} * c2) >> 32);
            const std::uint32_t low0 = 0xD2511F53 * c0;
            const std::uint32_t low1 = 0xCD9E8D57 * c2;
            c0 = high1 ^ c1 ^ k0;
            c1 = low1;
            c2 = high0 ^ c3 ^ k1;
            c3 = low0;
            k0 += 0x9E3779B9;
            k1 += 0xBB67AE85;
        }
        w0[i] = c0;
        w1[i] = c1;
        w2[i] = c2;
        w3[i] = c3;
    }
}

/// Box-Muller transform of one block: cosine[i] is sample 2 i, sine[i] is sample 2 i + 1.
///
/// The words w0 and w1 give u, with which the radius sqrt(-2 ln u) is computed.  The words w2 and
/// w3 give the angle, as a fraction of a turn.
///
/// The angle is reduced to an eighth of a turn by symmetry.  Sine and cosine there are Taylor
/// series to the powers 17 and 16 (the first term left out is below 2^-53).  Accuracy: sift_kernels.hpp.
inline void transform_block(const std::uint32_t* w0, const std::uint32_t* w1,
                            const std::uint32_t* w2, const std::uint32_t* w3, double* cosine,
                            double* sine) {
    A351_INDEPENDENT
    for (std::size_t i = 0; i < kNoiseBlock; ++i) {
        const double u = (upper_bits(w0[i], w1[i]) + 1.0) * 0x1p-53;
        const double radius = __builtin_sqrt(-2.0 * natural_log(u));
        // The two highest bits choose the quarter of the turn; within it, Taylor series up to an
        // eighth of a turn.
        const std::uint64_t quarter = std::uint64_t{w3[i]} >> 30;
        const double within = upper_bits(w2[i], w3[i] & 0x3FFFFFFF) * 0x1p-51;
        const bool mirrored = within > 0.5;
        const double angle = 1.5707963267948966 * (mirrored ? 1.0 - within : within);
        const double a2 = angle * angle;
        double c = 1.0;
        double s = 1.0;
        c = 1.0 - a2 * (1.0 / (15 * 16)) * c;
        s = 1.0 - a2 * (1.0 / (16 * 17)) * s;
        c = 1.0 - a2 * (1.0 / (13 * 14)) * c;
        s = 1.0 - a2 * (1.0 / (14 * 15)) * s;
        c = 1.0 - a2 * (1.0 / (11 * 12)) * c;
        s = 1.0 - a2 * (1.0 / (12 * 13)) * s;
        c = 1.0 - a2 * (1.0 / (9 * 10)) * c;
        s = 1.0 - a2 * (1.0 / (10 * 11)) * s;
        c = 1.0 - a2 * (1.0 / (7 * 8)) * c;
        s = 1.0 - a2 * (1.0 / (8 * 9)) * s;
        c = 1.0 - a2 * (1.0 / (5 * 6)) * c;
        s = 1.0 - a2 * (1.0 / (6 * 7)) * s;
        c = 1.0 - a2 * (1.0 / (3 * 4)) * c;
        s = 1.0 - a2 * (1.0 / (4 * 5)) * s;
        c = 1.0 - a2 * (1.0 / (1 * 2)) * c;
        s = (1.0 - a2 * (1.0 / (2 * 3)) * s) * angle;
        // Quarter 1 turns (c, s) into (-s, c), quarter 2 into (-c, -s), quarter 3 into (s, -c).
        const std::uint64_t exchange = 0 - ((mirrored ? 1U : 0U) ^ (quarter & 1));
        const std::uint64_t difference = (bits_of(c) ^ bits_of(s)) & exchange;
        const std::uint64_t x_sign = (quarter ^ (quarter >> 1)) << 63;
        const std::uint64_t y_sign = (quarter >> 1) << 63;
        cosine[i] = radius * double_of(bits_of(c) ^ difference ^ x_sign);
        sine[i] = radius * double_of(bits_of(s) ^ difference ^ y_sign);
    }
}

/// Fills noise[0 ... n - 1] with white Gaussian noise of variance 1; n = 0 writes nothing.  The
/// last block is computed completely and copied in part, so a shorter request has the same samples.
inline void fill_noise(std::uint64_t seed, std::uint64_t member, double* noise, std::size_t n) {
    std::uint32_t w0[kNoiseBlock], w1[kNoiseBlock], w2[kNoiseBlock], w3[kNoiseBlock];
    double cosine[kNoiseBlock], sine[kNoiseBlock];
    for (std::size_t begin = 0; begin < n; begin += 2 * kNoiseBlock) {
        philox_block(begin / 2, member, seed, w0, w1, w2, w3);
        transform_block(w0, w1, w2, w3, cosine, sine);
        const std::size_t count = n - begin < 2 * kNoiseBlock ? n - begin : 2 * kNoiseBlock;
        for (std::size_t i = 0; i + 1 < count; i += 2) {
            noise[begin + i] = cosine[i / 2];
            noise[begin + i + 1] = sine[i / 2];
        }
        if (count % 2 != 0) noise[begin + count - 1] = cosine[count / 2];
    }
}

}  // namespace
}  // namespace a351::corrector::eemd
