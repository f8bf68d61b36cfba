#include "corrector/eemd/sift_kernels.hpp"

namespace a351::corrector::eemd {

std::vector<const SiftKernels*> available_kernels() {
    std::vector<const SiftKernels*> available = {&portable_kernels()};
    for (const SiftKernels* const kernels : {avx2_kernels(), avx512_kernels()}) {
        if (kernels != nullptr) available.push_back(kernels);
    }
    return available;
}

const SiftKernels& fastest_kernels() noexcept {
    if (const SiftKernels* const kernels = avx512_kernels()) return *kernels;
    if (const SiftKernels* const kernels = avx2_kernels()) return *kernels;
    return portable_kernels();
}

}  // namespace a351::corrector::eemd
