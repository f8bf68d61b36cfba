#pragma once
/// @file
/// Cholesky decomposition of a symmetric positive definite matrix.
///
/// Use it for covariances and for the normal matrix of normal_matrix.hpp: it takes about half the
/// operations of an LU decomposition and shows whether the matrix is positive definite.  Do not use
/// it for nearly singular matrices: least squares without priors belong to PivotedQr, which works
/// on the rows themselves.
///
///     const Cholesky factor(normal_matrix(columns));
///     if (!factor.is_positive_definite()) return std::nullopt;
///     const Eigen::VectorXd estimate = factor.solve(columns.transpose() * values);
///     const Eigen::MatrixXd covariance = factor.inverse();

#include <Eigen/Core>

namespace a351::linear_algebra {

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
/// Cost: about n^3 / 3 operations in the constructor, once for any number of solutions.  Constant
/// members may be called from several threads at a time.
///
/// Units: L has the unit of the square root of A.  If A is a covariance in mGal^2, half_solve()
/// divides by standard deviations in mGal.
///
/// Source: Eigen::LLT, in place.
class Cholesky {
public:
    /// Decomposes A.  A matrix that is moved in is not copied.
    /// @param matrix  A (n, n), symmetric; only its lower triangle is read.
    explicit Cholesky(Eigen::MatrixXd matrix);

    /// Returns false if a pivot was not positive, or not finite.  Ask before calling other members.
    [[nodiscard]] bool is_positive_definite() const noexcept { return is_positive_definite_; }

    /// Returns L (n, n); its upper triangle is zero.  L z has the covariance A if the components of
    /// z are independent with variance 1.
    [[nodiscard]] Eigen::MatrixXd lower() const;
    /// Returns ln det A = 2 sum of ln L(k, k).  It is finite also where det A itself would overflow
    /// or underflow.
    [[nodiscard]] double log_determinant() const;
    /// Returns the solution X (n, m) of A X = right.  It costs 2 n^2 m operations.
    /// @param right  (n, m), finite; not checked.
    [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;
    /// Returns the solution x (n) of L x = right, so that |x|^2 = right' A^-1 right.  If A is the
    /// covariance of right, the components of x are independent with variance 1.
    /// @param right  (n), finite; not checked.
    [[nodiscard]] Eigen::VectorXd half_solve(Eigen::VectorXd right) const;
    /// Returns A^-1 (n, n).  Use solve() where only the product of A^-1 and a vector is needed.
    [[nodiscard]] Eigen::MatrixXd inverse() const;

private:
    [[nodiscard]] const Eigen::MatrixXd& factor() const;

    Eigen::MatrixXd factor_;  ///< L in the lower triangle; the upper one is not used.
    bool is_positive_definite_ = false;
};

}  // namespace a351::linear_algebra
