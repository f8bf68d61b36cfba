#pragma once
/// @file
/// The inner loop of a decimation: sums over the taps of a symmetric filter, two at a time.

#include <cstddef>
#include <span>
#include <vector>

namespace a351::corrector {

/// Two equal taps and the places of their samples for the first of the outputs.
struct TapPair {
    double tap = 0.0;
    std::size_t left = 0;
    std::size_t right = 0;
};

/// Outputs computed side by side: their sums fill half of the SSE2 registers.
inline constexpr std::size_t kSideBySide = 16;

/// For i = 0 ... kSideBySide - 1, terms in the order of `pairs`, none contracted:
///
///     sums[i] = sum over pairs of tap (samples[left + i] + samples[right + i])
using SumTapPairs = void (*)(std::span<const TapPair> pairs, const double* samples,
                             double* sums) noexcept;

/// The variants that this processor can run, the fastest last.  All give the same bits.
[[nodiscard]] std::vector<SumTapPairs> sum_tap_pairs_variants();

}  // namespace a351::corrector
