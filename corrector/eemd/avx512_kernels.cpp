#include "corrector/eemd/sift_kernels.hpp"

// Compiled with this instruction set where the compiler has it (CMakeLists.txt): nothing here may be
// shared with files that are not.
#ifdef __AVX512F__

#include "corrector/eemd/noise_loops.hpp"
#include "corrector/eemd/sift_loops.hpp"
#include "corrector/eemd/spline_loops.hpp"
#include "corrector/eemd/sum_loops.hpp"

namespace a351::corrector {

const SiftKernels* avx512_kernels() noexcept {
    static constexpr SiftKernels kernels = {
        "AVX-512",  find_extrema, fit_mean_envelope, subtract_mean_envelope,
        fill_noise, subtract,     accumulate};
    const bool available =
        __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
        __builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("bmi") != 0 &&
        __builtin_cpu_supports("popcnt") != 0;
    return available ? &kernels : nullptr;
}

}  // namespace a351::corrector

#else

namespace a351::corrector {

const SiftKernels* avx512_kernels() noexcept { return nullptr; }

}  // namespace a351::corrector

#endif
