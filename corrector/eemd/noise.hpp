#pragma once
/// @file
/// White Gaussian noise as a function of seed, member and sample, so that any thread can make any
/// part of it.
///
/// There is no generator with a state.  The same arguments give the same series, in any order of
/// calls and from any thread:
///
///     std::vector<double> noise(450);
///     fill_white_noise(seed, member, noise);
///     for (std::size_t i = 0; i < noise.size(); ++i) noisy[i] = signal[i] + level * noise[i];

#include <cstdint>
#include <span>

#include "corrector/eemd/sift_kernels.hpp"

namespace a351::corrector::eemd {

/// Fills `noise` with independent Gaussian samples of mean 0 and variance 1.
///
/// Samples 2 i and 2 i + 1 are sqrt(-2 ln u) cos(2 pi v) and sqrt(-2 ln u) sin(2 pi v), with u and
/// v uniform on multiples of 2^-53, 0 < u <= 1 and 0 <= v < 1, from the words of Philox 4x32-10
/// with counter (i, member) and key seed.  Hence a longer request begins with the shorter one, and
/// the largest magnitude is sqrt(2 ln 2^53) = 8.6.
///
/// Only exactly rounded operations are used, so that the bits do not depend on the platform's
/// mathematical library.  Accuracy: within 1e-13 of the formula (tests/unit/eemd/noise_test.cpp).
///
/// Mean, variance, fourth moment and correlation of neighbours are those of white Gaussian noise
/// within four standard errors of 10^6 samples (noise_test.cpp).
///
/// @param seed, member  any; each pair of values gives a different series.  Neighbouring values
///                      give unrelated series.
/// @param noise         (n), any n, also 0.
///                      Without unit; multiply by the standard deviation that is wanted.
///                      Only these elements are written, and nothing is allocated.
/// Sources: J. K. Salmon et al., Parallel random numbers: as easy as 1, 2, 3, SC11, 2011,
/// doi:10.1145/2063384.2063405; G. E. P. Box and M. E. Muller, Ann. Math. Stat. 29(2), 610-611,
/// 1958.
inline void fill_white_noise(std::uint64_t seed, std::uint64_t member,
                             std::span<double> noise) noexcept {
    fastest_kernels().fill_white_noise(seed, member, noise.data(), noise.size());
}

}  // namespace a351::corrector::eemd
