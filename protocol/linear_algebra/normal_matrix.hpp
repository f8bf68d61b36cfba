#pragma once
/// @file
/// Normal matrix of least squares with priors.

#include <Eigen/Core>

namespace a351::corrector {

/// Returns X'X + 1 (p, p): unknowns in units of their priors' standard deviations.
/// @param columns  X (n, p), rows in units of their noise.
[[nodiscard]] Eigen::MatrixXd normal_matrix(const Eigen::Ref<const Eigen::MatrixXd>& columns);

}  // namespace a351::corrector
