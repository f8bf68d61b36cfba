#pragma once
/// @file
/// The inner loops of sifting, once for each instruction set.  None contracts a product and a sum
/// into one rounding, and all do the same operations in the same order.  So all give the same bits
/// (tests/unit/eemd/sift_kernels_test.cpp).
///
/// Call fastest_kernels() for work and available_kernels() to compare instruction sets.  A table is
/// constant and lives as long as the program, and its functions have no state.  Any number of
/// threads may use one table at a time.
///
/// Functions of a table check nothing.  They do not allocate and do not throw.  A NaN or infinite
/// sample gives undefined extrema and curves.
///
/// Time per sample and sift on one core of a Zen 4: 0.95 ns with eight lanes, 1.1 with four, 2.2
/// with two (eemd.md).

#include <cstddef>
#include <cstdint>
#include <vector>

#include "corrector/eemd/mean_envelope.hpp"

namespace a351::corrector::eemd {

/// The loops of one instruction set.  Curves must have room up to a multiple of eight samples,
/// which the loops may read and write.
///
/// A pointer must refer to doubles; no alignment beyond that is needed.  AlignedBuffer makes the
/// search faster.  Arrays that a function reads and arrays that it writes must not overlap, unless
/// stated.
struct SiftKernels {
    const char* name;  ///< Name of the instruction set, for messages.

    /// Finds the interior extrema of `curve`, n >= 1, maxima and minima alternately.  A plateau
    /// between a rise and a fall is one extremum at its middle.  A plateau that touches an end is
    /// no extremum.
    /// The first extremum is a maximum if values[0] > curve[0].
    /// @param curve  (n), finite; n < 3 gives no extremum.
    /// @param positions, values  receive the extrema; up to eight elements beyond are overwritten.
    ///                Positions are samples from the first, in ascending order; a plateau of an
    ///                even number of samples has a position that ends in 0.5.
    /// @param starts  (n / 64 + 2) words; bit i is set if sample i is the first one at or after an
    ///                extremum, where a segment begins.
    /// @return the number of extrema.
    std::size_t (*find_extrema)(const double* curve, std::size_t n, double* positions,
                                double* values, std::uint64_t* starts);

    /// Fits not-a-knot splines through n >= 4 alternating knots at ascending positions x, and their
    /// mean.
    /// Eight elements beyond the end of x and y are read; their values do not matter.
    /// Knots k and k + 2 belong to one envelope.
    /// @param x  (n) positions, samples; strictly ascending within each envelope.
    /// @param y  (n) values, any unit; with magnitudes near 1 no product overflows.
    /// @param arrays  of a MeanEnvelope for n knots or more; receives the mean.
    /// Accuracy: within 1e-9 of dense solutions of the conditions, relative for values above 1
    /// (tests/unit/eemd/mean_envelope_test.cpp).
    void (*fit_mean_envelope)(const double* x, const double* y, std::size_t n,
                              const SplineArrays& arrays);

    /// Computes out = curve - mean envelope.  `out` may be `curve`.
    /// The cubics end before the last knots.  If both envelopes end at the last sample, the caller
    /// must set this sample of `out` (AlternatingKnots::ends_at_last_sample()).
    /// @param curve  (n), unit of the knots.
    /// @param starts  from find_extrema() of the curve to which the knots belong.
    /// @param x  the knots to which the envelopes were fitted.
    /// @param first_segment  index of the last knot at or before sample 0.
    /// @param arrays  from fit_mean_envelope().
    void (*subtract_mean_envelope)(const double* curve, double* out, std::size_t n,
                                   const std::uint64_t* starts, const double* x,
                                   std::size_t first_segment, const SplineArrays& arrays);

    /// Fills n samples with independent Gaussian noise of mean 0 and variance 1, as a function of
    /// seed, member and sample, so that any thread can make any part of it.
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
    /// @param noise         (n), any n, also 0; nothing beyond is written.
    /// Sources: J. K. Salmon et al., Parallel random numbers: as easy as 1, 2, 3, SC11, 2011,
    /// doi:10.1145/2063384.2063405; G. E. P. Box and M. E. Muller, Ann. Math. Stat. 29(2), 610-611,
    /// 1958.
    void (*fill_white_noise)(std::uint64_t seed, std::uint64_t member, double* noise,
                             std::size_t n);

    /// Computes from -= what for n samples.
    void (*subtract)(double* from, const double* what, std::size_t n);

    /// Computes sum += draw for n samples.
    /// @return the sum of (draw - origin)^2.
    double (*accumulate)(const double* draw, std::size_t n, double origin, double* sum);
};

/// Returns the loops with vectors of two, which every processor has.
/// They are SSE2 on amd64, NEON on arm64, and plain doubles elsewhere.
[[nodiscard]] const SiftKernels& portable_kernels() noexcept;
/// Returns the loops with vectors of four, or nullptr if compiler or processor lack them.
/// The processor needs AVX2, BMI and POPCNT.
[[nodiscard]] const SiftKernels* avx2_kernels() noexcept;
/// Returns the loops with vectors of eight, or nullptr if compiler or processor lack them.
/// The processor needs AVX-512 F, DQ and VL, BMI and POPCNT.
[[nodiscard]] const SiftKernels* avx512_kernels() noexcept;
/// Returns the loops with the widest vectors that this processor has.  It is the default
/// everywhere.
[[nodiscard]] const SiftKernels& fastest_kernels() noexcept;
/// Returns all loops that this processor can run, the portable ones first, then by vector width.
/// The result has at least one element, and no null pointer.
[[nodiscard]] std::vector<const SiftKernels*> available_kernels();

}  // namespace a351::corrector::eemd
