#pragma once
/// @file
/// Eigenvalues and eigenvectors of a symmetric matrix.

#include <Eigen/Core>

namespace a351::corrector {

/// Eigenvalues and eigenvectors of A:  A vectors.col(k) = values(k) vectors.col(k).
struct SymmetricEigen {
    Eigen::VectorXd values;   ///< (n), ascending, in the unit of A.
    Eigen::MatrixXd vectors;  ///< (n, n), columns of length 1; column k belongs to values(k).
};

/// Returns all eigenvalues and eigenvectors of a symmetric matrix.  The sign of each vector is
/// arbitrary.
///
/// Accuracy: |A v - lambda v| is below 1e-13 for a matrix of order 3 (linear_algebra_test.cpp).
///
/// @param matrix  A (n, n), n >= 1, symmetric, finite; not checked.  Only its lower triangle is
///                read.
///
/// Source: Eigen::SelfAdjointEigenSolver.
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix);

}  // namespace a351::corrector
