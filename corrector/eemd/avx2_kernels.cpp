#include "corrector/eemd/sift_kernels.hpp"

// Compiled for this instruction set if the compiler supports it (CMakeLists.txt).  Nothing here may
// be shared with files that are compiled without it.
#ifdef __AVX2__

#include "corrector/eemd/noise_loops.hpp"
#include "corrector/eemd/sift_loops.hpp"
#include "corrector/eemd/spline_loops.hpp"
#include "corrector/eemd/sum_loops.hpp"

namespace a351::corrector {

const SiftKernels* avx2_kernels() noexcept {
    static constexpr SiftKernels kernels = {
        "AVX2",     find_extrema, fit_mean_envelope, subtract_mean_envelope,
        fill_noise, subtract,     accumulate};
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
