#pragma once
/// @file
/// Inner loop of a decimation: sums over the taps of a symmetric filter, two at a time.
///
/// Only Decimator needs it.  The loop has its own header so that a test can run every variant, not
/// just the one that this processor selects.
///
///     double sums[kSideBySide];
///     sum_tap_pairs_variants().back()(pairs, samples, sums);

#include <cstddef>
#include <span>
#include <vector>

namespace a351::signal {

/// Two equal taps and the positions of their samples for the first of the outputs.  Positions count
/// from the begin of `samples`; output i uses the samples i places further.
struct TapPair {
    double tap = 0.0;       ///< Value of both taps, dimensionless.
    std::size_t left = 0;   ///< Position of the sample of the left tap.
    std::size_t right = 0;  ///< Position of the sample of the right tap.
};

/// Number of outputs computed side by side: their sums fill half of the SSE2 registers.
inline constexpr std::size_t kSideBySide = 16;

/// Computes the sums over all pairs for i = 0 ... kSideBySide - 1:
///
///     sums[i] = sum over pairs of tap (samples[left + i] + samples[right + i])
///
/// Terms are added in the order of `pairs`; no multiplication and addition are contracted to one
/// operation.  NaN and infinity propagate as in plain arithmetic.
/// `samples` must be readable up to position max(left, right) + kSideBySide - 1; `sums` takes
/// kSideBySide numbers.  Neither needs an alignment.  Without pairs all sums are 0.  The unit of
/// `sums` is that of `samples`.
using SumTapPairs = void (*)(std::span<const TapPair> pairs, const double* samples,
                             double* sums) noexcept;

/// Returns the variants of the loop that this processor can run, the fastest last.
///
/// The first variant runs on every processor; on x86-64 with AVX2 there is a second one.  The list
/// is never empty.  Allocates it, so call it once and keep the pointer.
///
/// Accuracy: all give the bits of plain arithmetic (decimator_test.cpp, "every variant of the inner
/// loop gives the same bits as plain arithmetic").
[[nodiscard]] std::vector<SumTapPairs> sum_tap_pairs_variants();

}  // namespace a351::signal
