#pragma once
/// @file
/// Cholesky decomposition of a symmetric positive definite matrix.

#include <Eigen/Core>

namespace a351::corrector {

/// Decomposes a matrix and solves linear systems with it:
///
///     A = L L',   L lower triangular with a positive diagonal
///
/// Errors: except for the constructor and is_positive_definite(), all members throw
/// std::invalid_argument if A is not positive definite.  A matrix with a NaN in its lower triangle
/// counts as not positive definite.  Sizes are checked by Eigen's assertions only.
///
/// Accuracy: residuals of L L' - A, A X - right and L x - right are below 1e-14 for a
/// well-conditioned matrix of order 3 (linear_algebra_test.cpp).
///
/// Source: Eigen::LLT, in place.
class Cholesky {
public:
    /// Decomposes A.
    /// @param matrix  A (n, n), symmetric; only its lower triangle is read.
    explicit Cholesky(Eigen::MatrixXd matrix);

    /// Returns false if a pivot was not positive, or not finite.
    [[nodiscard]] bool is_positive_definite() const noexcept { return is_positive_definite_; }

    /// Returns L (n, n); its upper triangle is zero.
    [[nodiscard]] Eigen::MatrixXd lower() const;
    /// Returns ln det A = 2 sum of ln L(k, k).
    [[nodiscard]] double log_determinant() const;
    /// Returns the solution X (n, m) of A X = right.
    /// @param right  (n, m), finite; not checked.
    [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;
    /// Returns the solution x (n) of L x = right, so that |x|^2 = right' A^-1 right.
    /// @param right  (n), finite; not checked.
    [[nodiscard]] Eigen::VectorXd half_solve(Eigen::VectorXd right) const;
    /// Returns A^-1 (n, n).
    [[nodiscard]] Eigen::MatrixXd inverse() const;

private:
    [[nodiscard]] const Eigen::MatrixXd& factor() const;

    Eigen::MatrixXd factor_;  ///< L in the lower triangle; the upper one is not used.
    bool is_positive_definite_ = false;
};

}  // namespace a351::corrector
