#pragma once
/// @file
/// The inner loops of sifting for one instruction set each.  None contracts a product and a sum
/// into one rounding, and all do the same operations in the same order: the bits are the same.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "corrector/eemd/mean_envelope.hpp"

namespace a351::corrector {

/// Curves must have room up to a multiple of eight samples, and may be read and written there.
struct SiftKernels {
    const char* name;  ///< Name of the instruction set, for messages.

    /// Interior extrema of `curve`, n >= 1, maxima and minima alternately, and where they begin a
    /// segment: bit i of `starts` (n / 64 + 2 words) is the first sample at or after one.  A
    /// plateau between a rise and a fall is one extremum at its middle; one that touches an end is
    /// none.
    /// @return their number; up to eight elements beyond are overwritten.
    std::size_t (*find_extrema)(const double* curve, std::size_t n, double* positions,
                                double* values, std::uint64_t* starts);

    /// Splines through n >= 4 alternating knots at ascending positions x, and their mean.  Of x and
    /// y eight elements beyond are read, whatever they hold.
    void (*fit_mean_envelope)(const double* x, const double* y, std::size_t n, SplineEnds ends,
                              const SplineArrays& arrays);

    /// out = curve - mean envelope; x: the knots it was fitted to, `first_segment` the one that
    /// holds sample 0.  `out` may be `curve`.
    void (*subtract_mean_envelope)(const double* curve, double* out, std::size_t n,
                                   const std::uint64_t* starts, const double* x,
                                   std::size_t first_segment, const SplineArrays& arrays);

    /// White noise, see noise.hpp.
    void (*fill_white_noise)(std::uint64_t seed, std::uint64_t member, double* noise,
                             std::size_t n);

    /// from -= what, n samples.
    void (*subtract)(double* from, const double* what, std::size_t n);

    /// sum += draw, n samples.  @return the sum of (draw - origin)^2.
    double (*accumulate)(const double* draw, std::size_t n, double origin, double* sum);
};

/// Vectors of two, which every processor has.
[[nodiscard]] const SiftKernels& portable_kernels() noexcept;
/// nullptr where the compiler, or the processor, does not have them.
[[nodiscard]] const SiftKernels* avx2_kernels() noexcept;
[[nodiscard]] const SiftKernels* avx512_kernels() noexcept;
/// The fastest this processor has.
[[nodiscard]] const SiftKernels& fastest_kernels() noexcept;
/// All this processor has, the portable ones first.
[[nodiscard]] std::vector<const SiftKernels*> available_kernels();

}  // namespace a351::corrector
