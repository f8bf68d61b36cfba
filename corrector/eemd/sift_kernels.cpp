#include "corrector/eemd/sift_kernels.hpp"

namespace a351::corrector {

const SiftKernels& fastest_kernels() noexcept {
    const SiftKernels* const avx2 = avx2_kernels();
    return avx2 != nullptr ? *avx2 : portable_kernels();
}

}  // namespace a351::corrector
