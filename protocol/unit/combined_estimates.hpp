#pragma once
/// @file
/// One estimate from several independent ones of the same coefficients.
///
///     const AxisBias bias = combined<2>({first.bias, second.bias});

#include <vector>

#include "protocol/linear_algebra/cholesky.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::unit {

/// Returns the mean of independent estimates x_i with covariances C_i, each weighted by its
/// information:
///
///     C = (sum of C_i^-1)^-1,  x = C sum of C_i^-1 x_i
///
/// A prior counts as an estimate, so no other estimate may contain it.  Disagreement of the
/// estimates does not widen the covariance.  A single estimate is returned as it is.
/// @param estimates  at least one; covariances positive definite.
template <int kCount>
[[nodiscard]] CalibratedCoefficients<kCount> combined(
    const std::vector<CalibratedCoefficients<kCount>>& estimates) {
    if (estimates.size() == 1) return estimates.front();
    Eigen::Matrix<double, kCount, kCount> information =
        Eigen::Matrix<double, kCount, kCount>::Zero();
    Eigen::Matrix<double, kCount, 1> weighted = Eigen::Matrix<double, kCount, 1>::Zero();
    for (const CalibratedCoefficients<kCount>& one : estimates) {
        const Eigen::Matrix<double, kCount, kCount> inverse =
            linear_algebra::Cholesky(one.covariance).inverse();
        information += inverse;
        weighted += inverse * one.values;
    }
    const Eigen::Matrix<double, kCount, kCount> covariance =
        linear_algebra::Cholesky(information).inverse();
    CalibratedCoefficients<kCount> together;
    together.values = covariance * weighted;
    together.covariance = covariance.template selfadjointView<Eigen::Upper>();
    return together;
}

}  // namespace a351::unit
