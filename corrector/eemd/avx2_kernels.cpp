#include "corrector/eemd/sift_kernels.hpp"

// Compiled with -mavx2 where the compiler has it (CMakeLists.txt); nothing here may be shared with
// files that are not.
#ifdef __AVX2__

#include <immintrin.h>

#include "corrector/eemd/noise_loops.hpp"
#include "corrector/eemd/spline_loops.hpp"
#include "corrector/eemd/sum_loops.hpp"

namespace a351::corrector {
namespace {

/// For every set of four flags eight 32-bit indices, that is four of doubles.
struct LaneTables {
    alignas(32) std::int32_t flagged[16][8] = {};   ///< the flagged lanes, moved to the front
    alignas(32) std::int32_t segments[16][8] = {};  ///< flags before each lane
};

constexpr LaneTables make_tables() {
    LaneTables tables;
    for (int flags = 0; flags < 16; ++flags) {
        int before = 0;
        for (int lane = 0; lane < 4; ++lane) {
            for (int half = 0; half < 2; ++half) {
                tables.segments[flags][2 * lane + half] = 2 * before + half;
                if ((flags >> lane & 1) != 0) {
                    tables.flagged[flags][2 * before + half] = 2 * lane + half;
                }
            }
            before += flags >> lane & 1;
        }
    }
    return tables;
}

constexpr LaneTables kTables = make_tables();

/// Flags shifted by two are their row's offset in eight bytes, which addresses scale by.
constexpr int kRowShift = 2;
constexpr std::uint64_t kRowMask = 15 << kRowShift;

inline __m256i row_of(const std::int32_t (&table)[16][8], std::uint64_t offset) {
    const std::int32_t* const row = &table[0][0] + 2 * offset;
    return _mm256_load_si256(reinterpret_cast<const __m256i*>(row));
}

inline __m256d permute(__m256d values, __m256i lanes) {
    return _mm256_castps_pd(_mm256_permutevar8x32_ps(_mm256_castpd_ps(values), lanes));
}

/// Bits i = 0 ... count - 1: curve[i + 1] > curve[i].  `equal` collects pairs that are equal.
inline std::uint64_t rises(const double* curve, std::size_t count, __m256d& equal) {
    std::uint64_t bits = 0;
    std::size_t i = 0;
    for (; i + 4 <= count; i += 4) {
        const __m256d here = _mm256_loadu_pd(curve + i);
        const __m256d next = _mm256_loadu_pd(curve + i + 1);
        equal = _mm256_or_pd(equal, _mm256_cmp_pd(next, here, _CMP_EQ_OQ));
        const int up = _mm256_movemask_pd(_mm256_cmp_pd(next, here, _CMP_GT_OQ));
        bits |= static_cast<std::uint64_t>(static_cast<unsigned>(up)) << i;
    }
    for (; i < count; ++i) {
        const __m256d here = _mm256_set1_pd(curve[i]);
        const __m256d next = _mm256_set1_pd(curve[i + 1]);
        equal = _mm256_or_pd(equal, _mm256_cmp_pd(next, here, _CMP_EQ_OQ));
        bits |= std::uint64_t{curve[i + 1] > curve[i]} << i;
    }
    return bits;
}

/// Above so many extrema in 64 samples all are looked at four at a time.
constexpr int kDense = 20;

std::size_t find_extrema(const double* curve, std::size_t n, double* positions, double* values,
                         std::uint64_t* starts) {
    std::size_t count = 0;
    std::size_t word = 0;
    __m256d equal = _mm256_setzero_pd();
    std::uint64_t last_rise = n > 1 && curve[1] > curve[0] ? 1 : 0;
    for (; 64 * word + 1 < n; ++word) {
        const std::size_t begin = 64 * word;
        const double* const here = curve + begin;
        const bool whole = n - 1 - begin >= 64;
        const std::uint64_t up = whole ? rises(here, 64, equal) : rises(here, n - 1 - begin, equal);
        std::uint64_t turns = up ^ (up << 1 | last_rise);
        last_rise = up >> 63;
        if (!whole) turns &= (std::uint64_t{1} << (n - 1 - begin)) - 1;
        starts[word] = turns;
        if (whole && __builtin_popcountll(turns) > kDense) {
            __m256d position = _mm256_add_pd(_mm256_set1_pd(static_cast<double>(begin)),
                                             _mm256_setr_pd(0.0, 1.0, 2.0, 3.0));
            for (std::size_t i = 0; i < 64; i += 4) {
                const std::uint64_t flags = turns >> i & 15;
                const __m256i lanes = row_of(kTables.flagged, flags << kRowShift);
                _mm256_storeu_pd(positions + count, permute(position, lanes));
                _mm256_storeu_pd(values + count, permute(_mm256_loadu_pd(here + i), lanes));
                count += static_cast<std::size_t>(__builtin_popcountll(flags));
                position = _mm256_add_pd(position, _mm256_set1_pd(4.0));
            }
        } else {
            for (; turns != 0; turns &= turns - 1) {
                const std::size_t i = begin + static_cast<std::size_t>(__builtin_ctzll(turns));
                positions[count] = static_cast<double>(static_cast<std::int64_t>(i));
                values[count] = curve[i];
                ++count;
            }
        }
    }
    if (_mm256_movemask_pd(equal) != 0) {
        return portable_kernels().find_extrema(curve, n, positions, values, starts);
    }
    for (; word < n / 64 + 2; ++word) starts[word] = 0;
    return count;
}

/// Cubics of four samples and how far those are behind their knots.
struct Cubics {
    __m256d d, y, b, c, e;
};

/// out = curve - cubics, four samples.
inline void subtract_cubics(const double* curve, double* out, const Cubics& at) {
    const __m256d line = _mm256_add_pd(at.y, _mm256_mul_pd(at.d, at.b));
    const __m256d bend = _mm256_add_pd(at.c, _mm256_mul_pd(at.d, at.e));
    const __m256d rest = _mm256_sub_pd(_mm256_loadu_pd(curve), line);
    _mm256_storeu_pd(out, _mm256_sub_pd(rest, _mm256_mul_pd(_mm256_mul_pd(at.d, at.d), bend)));
}

void subtract_mean_envelope(const double* curve, double* out, std::size_t n,
                            const std::uint64_t* starts, const double* x, std::size_t first_segment,
                            const SplineArrays& arrays) {
    const double* const y = arrays.mean_y;
    const double* const b = arrays.mean_b;
    const double* const c = arrays.mean_c;
    const double* const e = arrays.mean_e;
    std::size_t k = first_segment;
    const __m256d first_four = _mm256_setr_pd(0.0, 1.0, 2.0, 3.0);
    const __m256d four = _mm256_set1_pd(4.0);
    __m256d t = first_four;
    const auto next_cubics = [&](std::uint64_t row) {
        const __m256i lanes = row_of(kTables.segments, row);
        const auto of_lanes = [&](const double* from) {
            return permute(_mm256_loadu_pd(from + k), lanes);
        };
        const Cubics cubics = {_mm256_sub_pd(t, of_lanes(x)), of_lanes(y), of_lanes(b), of_lanes(c),
                               of_lanes(e)};
        k += static_cast<std::size_t>(__builtin_popcountll(row));
        t = _mm256_add_pd(t, four);
        return cubics;
    };
    for (std::size_t word = 0; 64 * word < n; ++word) {
        // Bit i: a segment begins at the sample after i.
        std::uint64_t bits = starts[word] >> 1 | starts[word + 1] << 63;
        const std::size_t begin = 64 * word;
        const std::size_t end = n - begin < 64 ? n : begin + 64;
        const auto offset = static_cast<double>(static_cast<std::int64_t>(begin));
        t = _mm256_add_pd(first_four, _mm256_set1_pd(offset));
        if (bits == 0) {
            Cubics cubics = {_mm256_sub_pd(t, _mm256_set1_pd(x[k])), _mm256_set1_pd(y[k]),
                             _mm256_set1_pd(b[k]), _mm256_set1_pd(c[k]), _mm256_set1_pd(e[k])};
            for (std::size_t i = begin; i < end; i += 4) {
                subtract_cubics(curve + i, out + i, cubics);
                cubics.d = _mm256_add_pd(cubics.d, four);
            }
            continue;
        }
        // One step ahead of the arithmetic, which would fill the processor's queue with waiting.
        Cubics cubics = next_cubics(bits << kRowShift & kRowMask);
        std::uint64_t rows = bits >> 4 << kRowShift;  // never more than 62 bits
        std::size_t i = begin;
#pragma GCC unroll 5
        for (; i + 4 < end; i += 4) {
            const Cubics next = next_cubics(rows & kRowMask);
            rows >>= 4;
            subtract_cubics(curve + i, out + i, cubics);
            cubics = next;
        }
        subtract_cubics(curve + i, out + i, cubics);
    }
}

}  // namespace

const SiftKernels* avx2_kernels() noexcept {
    static constexpr SiftKernels kernels = {find_extrema, fit_mean_envelope, subtract_mean_envelope,
                                            fill_noise,   subtract,          accumulate};
    const bool available = __builtin_cpu_supports("avx2") != 0 &&
                           __builtin_cpu_supports("bmi") != 0 &&
                           __builtin_cpu_supports("popcnt") != 0;
    return available ? &kernels : nullptr;
}

}  // namespace a351::corrector

#else

namespace a351::corrector {

const SiftKernels* avx2_kernels() noexcept { return nullptr; }

}  // namespace a351::corrector

#endif
