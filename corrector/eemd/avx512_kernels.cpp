#include "corrector/eemd/sift_kernels.hpp"

// Compiled for this instruction set if the compiler supports it (CMakeLists.txt).  Nothing here may
// be shared with files that are compiled without it.
#ifdef __AVX512F__
#include "corrector/eemd/kernel_table.hpp"
#endif

namespace a351::corrector::eemd {

const SiftKernels* avx512_kernels() noexcept {
#ifdef __AVX512F__
    static constexpr SiftKernels kernels = table_of_loops("AVX-512");
    if (__builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
        __builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("bmi") != 0 &&
        __builtin_cpu_supports("popcnt") != 0) {
        return &kernels;
    }
#endif
    return nullptr;
}

}  // namespace a351::corrector::eemd
