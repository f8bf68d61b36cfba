#pragma once
/// @file
/// White Gaussian noise that any thread can make anywhere: a function of seed, member and sample.

#include <array>
#include <cstdint>
#include <span>

namespace a351::corrector {

/// Philox 4x32-10: four random words for each counter and key.
/// Source: J. K. Salmon et al., Parallel random numbers: as easy as 1, 2, 3, SC11, 2011,
/// doi:10.1145/2063384.2063405.
[[nodiscard]] std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                                  std::array<std::uint32_t, 2> key) noexcept;

/// Fills `noise` with independent samples of mean 0 and variance 1.
///
/// Only exactly rounded operations are used, so that the bits do not depend on the platform's
/// mathematical library.  Largest magnitude: sqrt(2 ln 2^53) = 8.6.
/// Source: G. E. P. Box and M. E. Muller, Ann. Math. Stat. 29(2), 610-611, 1958.
void fill_white_noise(std::uint64_t seed, std::uint64_t member, std::span<double> noise) noexcept;

}  // namespace a351::corrector
