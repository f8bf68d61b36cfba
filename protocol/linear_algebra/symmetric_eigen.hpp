#pragma once
/// @file
/// Eigenvalues and eigenvectors of a symmetric matrix.
///
/// Use it for the principal axes of a covariance: the variance along vectors.col(k) is values(k),
/// and the last column is the direction of largest variance.  To solve a linear system use
/// Cholesky, which costs much less.

#include <Eigen/Core>

namespace a351::linear_algebra {

/// Eigenvalues and eigenvectors of A:  A vectors.col(k) = values(k) vectors.col(k).
///
/// The vectors are orthogonal: A = vectors diag(values) vectors'.  Both members have their own
/// memory and do not refer to A.
struct SymmetricEigen {
    Eigen::VectorXd values;   ///< (n), ascending, in the unit of A.
    Eigen::MatrixXd vectors;  ///< (n, n), columns of length 1; column k belongs to values(k).
};

/// Returns all eigenvalues and eigenvectors of a symmetric matrix.  The sign of each vector is
/// arbitrary.  If eigenvalues are equal, only the space of their vectors is determined.
///
/// Rounding can make a zero eigenvalue slightly negative.  Its size is then of the order of n eps
/// times the largest |eigenvalue|, with eps = 2.2e-16.
///
/// Accuracy: |A v - lambda v| is below 1e-13 for a matrix of order 3 (linear_algebra_test.cpp).
///
/// Cost: proportional to n^3.  Any number of threads may call it.
///
/// @param matrix  A (n, n), n >= 1, symmetric, finite; not checked.  Only its lower triangle is
///                read.
///
/// Source: Eigen::SelfAdjointEigenSolver.
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix);

}  // namespace a351::linear_algebra
