#include "corrector/noise/limits.hpp"

#include "protocol/signal/distributions.hpp"

namespace a351::corrector::noise {

Limits variance_limits(double variance, double dof) {
    constexpr double kTail = 0.025;
    return {variance, variance * dof / signal::chi_square_upper_quantile(dof, kTail),
            variance * dof / signal::chi_square_quantile(dof, kTail)};
}

}  // namespace a351::corrector::noise
