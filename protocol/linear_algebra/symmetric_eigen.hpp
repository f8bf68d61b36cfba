#pragma once
/// @file
/// Eigenvalues and eigenvectors of a symmetric matrix.

#include <Eigen/Core>

namespace a351::corrector {

struct SymmetricEigen {
    Eigen::VectorXd values;   ///< (n), ascending.
    Eigen::MatrixXd vectors;  ///< (n, n) of length 1; column k belongs to values(k).
};

/// Returns the decomposition of a symmetric matrix.
/// @param matrix  (n, n) symmetric, finite; only its lower triangle is read.
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix);

}  // namespace a351::corrector
