#pragma once
/// @file
/// Sums over samples, and the table of all loops, compiled once for every instruction set.  The
/// rules are in sift_kernels.hpp.
///
/// Include it only in the source file of one instruction set (portable_kernels.cpp,
/// avx2_kernels.cpp, avx512_kernels.cpp), which is compiled for this set.  All names are internal
/// to the including file.  A function shared between two such files could contain instructions that
/// the processor lacks.

#include <cstddef>

#include "corrector/eemd/lanes.hpp"
#include "corrector/eemd/noise_loops.hpp"
#include "corrector/eemd/sift_kernels.hpp"
#include "corrector/eemd/sift_loops.hpp"
#include "corrector/eemd/spline_loops.hpp"

namespace a351::corrector::eemd {
namespace {

/// Four samples, or four partial sums.  A single sum would have to wait for every addition.
typedef double Quad __attribute__((vector_size(32), aligned(8), may_alias));

/// Computes from[i] -= what[i] for i < n.  The arrays must not overlap.  Nothing beyond n is
/// touched.
inline void subtract(double* from, const double* what, std::size_t n) {
    A351_INDEPENDENT
    for (std::size_t i = 0; i < n; ++i) from[i] -= what[i];
}

/// Computes sum[i] += draw[i] for i < n, and returns the sum of (draw[i] - origin)^2.
///
/// The squares are added in four partial sums, one per sample number modulo 4, on every instruction
/// set.  The last n % 4 samples are added one by one.  Hence the bits do not depend on the lanes.
///
/// @param origin  value about which the squares are taken, unit of the draw.
/// @param sum  (n), must not overlap with `draw`.
inline double accumulate(const double* draw, std::size_t n, double origin, double* sum) {
    Quad squares = {0.0, 0.0, 0.0, 0.0};
    std::size_t i = 0;
    for (; i + 4 <= n; i += 4) {
        const Quad value = *reinterpret_cast<const Quad*>(draw + i);
        *reinterpret_cast<Quad*>(sum + i) += value;
        const Quad deviation = value - origin;
        squares += deviation * deviation;
    }
    double total = (squares[0] + squares[1]) + (squares[2] + squares[3]);
    for (; i < n; ++i) {
        sum[i] += draw[i];
        total += (draw[i] - origin) * (draw[i] - origin);
    }
    return total;
}

/// Returns the table of the loops above and in the included files, in the order of SiftKernels.
/// @param name  name of the instruction set; must live as long as the table.
constexpr SiftKernels table_of_loops(const char* name) {
    return {name,       find_extrema, fit_mean_envelope, subtract_mean_envelope,
            fill_noise, subtract,     accumulate};
}

}  // namespace
}  // namespace a351::corrector::eemd
