#include "corrector/eemd/kernel_table.hpp"

namespace a351::corrector::eemd {

const SiftKernels& portable_kernels() noexcept {
    static constexpr SiftKernels kernels = table_of_loops("portable");
    return kernels;
}

}  // namespace a351::corrector::eemd
