#include "corrector/eemd/noise_loops.hpp"
#include "corrector/eemd/sift_kernels.hpp"
#include "corrector/eemd/spline_loops.hpp"
#include "corrector/eemd/sum_loops.hpp"

namespace a351::corrector {
namespace {

std::size_t find_extrema(const double* curve, std::size_t n, double* positions, double* values,
                         std::uint64_t* starts) {
    // Every step writes its candidate and keeps it by counting: noise would make branches here the
    // slowest part of a sift.
    std::size_t count = 0;
    bool was_rising = false;
    bool was_falling = false;
    std::size_t level_begin = 0;
    for (std::size_t i = 1; i < n; ++i) {
        const double before = curve[i - 1];
        const bool rises = curve[i] > before;
        const bool falls = curve[i] < before;
        positions[count] = 0.5 * static_cast<double>(level_begin + i - 1);
        values[count] = before;
        count += static_cast<std::size_t>((was_rising & falls) | (was_falling & rises));
        const bool moves = rises | falls;
        level_begin = moves ? i : level_begin;
        was_rising = moves ? rises : was_rising;
        was_falling = moves ? falls : was_falling;
    }
    for (std::size_t word = 0; word < n / 64 + 2; ++word) starts[word] = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const double half_more = positions[k] + 0.5;  // cut off: the ceiling
        const auto start = static_cast<std::size_t>(half_more);
        starts[start / 64] |= std::uint64_t{1} << (start % 64);
    }
    return count;
}

void subtract_mean_envelope(const double* curve, double* out, std::size_t n,
                            const std::uint64_t* starts, const double* x, std::size_t first_segment,
                            const SplineArrays& arrays) {
    std::size_t k = first_segment;
    std::size_t i = 0;
    const auto subtract_until = [&](std::size_t end) {
        const double origin = x[k];
        const double y = arrays.mean_y[k];
        const double b = arrays.mean_b[k];
        const double c = arrays.mean_c[k];
        const double e = arrays.mean_e[k];
        for (; i < end; ++i) {
            const double d = static_cast<double>(i) - origin;
            // In halves, see average() in spline_loops.hpp.
            out[i] = (curve[i] - (y + d * b)) - d * d * (c + d * e);
        }
    };
    for (std::size_t word = 0; 64 * word < n; ++word) {
        for (std::uint64_t bits = starts[word]; bits != 0; bits &= bits - 1) {
            subtract_until(64 * word + static_cast<std::size_t>(__builtin_ctzll(bits)));
            ++k;
        }
    }
    subtract_until(n);
}

}  // namespace

const SiftKernels& portable_kernels() noexcept {
    static constexpr SiftKernels kernels = {find_extrema, fit_mean_envelope, subtract_mean_envelope,
                                            fill_noise,   subtract,          accumulate};
    return kernels;
}

}  // namespace a351::corrector
