#pragma once
/// @file
/// Normal matrix of least squares with priors.
///
/// Use it with Cholesky where every unknown has a prior: the matrix is then never singular.  Where
/// an unknown has none, use PivotedQr on the rows, which keeps the accuracy that X'X loses.

#include <Eigen/Core>

namespace a351::linear_algebra {

/// Returns the normal matrix of least squares in which every unknown has a prior:
///
///     X'X + I
///
/// The unknowns are in units of the standard deviations of their priors, so that each prior adds 1
/// to the diagonal.  The matrix is symmetric, and positive definite if X is finite.  A NaN in
/// column k of X gives NaN in row and column k.
///
/// With y (n) in the units of the rows and priors of mean 0, the estimate is (X'X + I)^-1 X'y.  Its
/// covariance is (X'X + I)^-1.  Multiply row and column k of it by the deviation of prior k to get
/// back the unit of the unknown.
///
/// Accuracy: rounding (linear_algebra_test.cpp, "a normal matrix includes a unit prior for each
/// unknown on its diagonal").  Cost: about 2 n p^2 operations; it allocates the result.
///
/// @param columns  X (n, p), rows in units of the standard deviation of their noise; n = 0 gives I.
/// @return (p, p), dimensionless.
[[nodiscard]] Eigen::MatrixXd normal_matrix(const Eigen::Ref<const Eigen::MatrixXd>& columns);

/// Returns -2 ln of the likelihood of readings whose unknowns are integrated out with their priors,
/// up to a constant:
///
///     ln det(X'X + I) + y'y - |L^-1 X'y|^2,  L L' = X'X + I
///
/// This is ln det C + y' C^-1 y with the covariance C = I + XX' of the readings
/// (linear_algebra_test.cpp).
/// @param columns   X (n, p), as for normal_matrix().
/// @param readings  y (n), in units of the standard deviation of their noise.
/// @return infinite if X'X overflows.
[[nodiscard]] double marginal_cost(const Eigen::Ref<const Eigen::MatrixXd>& columns,
                                   const Eigen::Ref<const Eigen::VectorXd>& readings);

}  // namespace a351::linear_algebra
