#pragma once
/// @file
/// Normal matrix of least squares with priors.

#include <Eigen/Core>

namespace a351::corrector {

/// Returns the normal matrix of least squares in which every unknown has a prior:
///
///     X'X + I
///
/// The unknowns are in units of the standard deviations of their priors, so that each prior adds 1
/// to the diagonal.  The matrix is symmetric, and positive definite if X is finite.  A NaN in
/// column k of X gives NaN in row and column k.
///
/// Accuracy: rounding (linear_algebra_test.cpp, "a normal matrix has unit priors on its diagonal").
///
/// @param columns  X (n, p), rows in units of the standard deviation of their noise; n = 0 gives I.
/// @return (p, p), dimensionless.
[[nodiscard]] Eigen::MatrixXd normal_matrix(const Eigen::Ref<const Eigen::MatrixXd>& columns);

}  // namespace a351::corrector
