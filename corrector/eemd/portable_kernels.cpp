#include "corrector/eemd/noise_loops.hpp"
#include "corrector/eemd/sift_kernels.hpp"
#include "corrector/eemd/sift_loops.hpp"
#include "corrector/eemd/spline_loops.hpp"
#include "corrector/eemd/sum_loops.hpp"

namespace a351::corrector {

const SiftKernels& portable_kernels() noexcept {
    static constexpr SiftKernels kernels = {
        "portable", find_extrema, fit_mean_envelope, subtract_mean_envelope,
        fill_noise, subtract,     accumulate};
    return kernels;
}

}  // namespace a351::corrector
