#pragma once
/// @file
/// White Gaussian noise for made-up series: the noise of an ensemble's member.
///
///     std::vector<double> noise(450);
///     fill_white_noise(seed, member, noise);

#include <cstdint>
#include <span>

#include "corrector/eemd/sift_kernels.hpp"

namespace a351::corrector::eemd {

/// Fills `noise` as SiftKernels::fill_white_noise does.
inline void fill_white_noise(std::uint64_t seed, std::uint64_t member,
                             std::span<double> noise) noexcept {
    fastest_kernels().fill_white_noise(seed, member, noise.data(), noise.size());
}

}  // namespace a351::corrector::eemd
