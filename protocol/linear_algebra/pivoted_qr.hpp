#pragma once
/// @file
/// QR decomposition with column pivoting, for least squares.

#include <Eigen/Core>
#include <memory>

namespace a351::corrector {

/// Decomposes a matrix by Householder reflections with column pivoting, and solves least squares:
///
///     A P = Q R,   P a permutation, Q orthogonal, R upper triangular
///
/// Nothing is checked: A must be finite, with n >= p, and have rank p where stated.
///
/// Accuracy: least squares of 4 rows and 2 columns are exact to 1e-13, the cofactor matrix to
/// 1e-10; two proportional columns have rank 1 (linear_algebra_test.cpp).
///
/// Source: Eigen::ColPivHouseholderQR.
class PivotedQr {
public:
    /// Decomposes A; the input is not checked.
    /// @param matrix  A (n, p), finite, n >= p.
    explicit PivotedQr(const Eigen::MatrixXd& matrix);
    ~PivotedQr();

    /// Returns the pivots |R(k, k)| (p), the largest first up to rounding.
    [[nodiscard]] Eigen::VectorXd pivots() const;
    /// Returns the numerical rank: the number of pivots above p eps times the largest.
    [[nodiscard]] Eigen::Index rank() const;
    /// Returns the x (p) of least |A x - right|.  A must have rank p.
    /// @param right  (n), finite.
    [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
    /// Returns the root S = P R^-1 (p, p) of the cofactor matrix: S S' = (A' A)^-1.  A must have
    /// rank p.
    [[nodiscard]] Eigen::MatrixXd cofactor_root() const;

private:
    struct Decomposition;
    std::unique_ptr<const Decomposition> decomposition_;
};

}  // namespace a351::corrector
