#pragma once
/// @file
/// QR decomposition with column pivoting, for least squares.
///
/// Use it where columns may depend on each other, or where unknowns have no prior: it works on the
/// rows themselves, so the condition of the problem is not squared as in a normal matrix.
///
///     const PivotedQr qr(rows);
///     if (qr.rank() < rows.cols()) return std::nullopt;  // columns depend on each other
///     const Eigen::VectorXd estimate = qr.solve(values);
///     const Eigen::MatrixXd root = qr.cofactor_root();
///     const Eigen::MatrixXd cofactor = root * root.transpose();
///
/// Append a row for each prior.  If the other rows are divided by the standard deviation of their
/// noise, this row has 1 / (standard deviation of the prior) in the column of its unknown.

#include <Eigen/Core>
#include <memory>

namespace a351::linear_algebra {

/// Decomposes a matrix by Householder reflections with column pivoting, and solves least squares:
///
///     A P = Q R,   P a permutation, Q orthogonal, R upper triangular
///
/// Nothing is checked: A must be finite, with n >= p, and have rank p where stated.
///
/// Accuracy: least squares of 4 rows and 2 columns are exact to 1e-13, the cofactor matrix to
/// 1e-10; two proportional columns have rank 1 (linear_algebra_test.cpp).
///
/// Cost: about 2 n p^2 operations in the constructor, once for any number of solutions.  The object
/// keeps a matrix of the size of A and cannot be copied or moved.  Constant members may be called
/// from several threads at a time.
///
/// Source: Eigen::ColPivHouseholderQR.
class PivotedQr {
public:
    /// Decomposes A; the input is not checked.
    /// @param matrix  A (n, p), finite, n >= p.
    explicit PivotedQr(const Eigen::MatrixXd& matrix);
    ~PivotedQr();

    /// Returns the pivots |R(k, k)| (p), the largest first up to rounding.  They are in the units
    /// of A and in the order of P, not of the columns of A.
    [[nodiscard]] Eigen::VectorXd pivots() const;
    /// Returns the numerical rank: the number of pivots above p eps times the largest.
    ///
    /// eps is 2.2e-16.  The rank depends on the scale of the columns: scale them to similar size
    /// before, or compare pivots() with the noise of A.
    [[nodiscard]] Eigen::Index rank() const;
    /// Returns the x (p) of least |A x - right|.  A must have rank p.  Otherwise x is one of many
    /// solutions, and rounding can make it very large.
    /// @param right  (n), finite.
    [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
    /// Returns the root S = P R^-1 (p, p) of the cofactor matrix: S S' = (A' A)^-1.  A must have
    /// rank p.  Otherwise elements are very large, infinite or NaN.
    ///
    /// If the components of `right` have independent errors of standard deviation s, that of x(k)
    /// is s times the length of row k of S.
    [[nodiscard]] Eigen::MatrixXd cofactor_root() const;

private:
    struct Decomposition;
    std::unique_ptr<const Decomposition> decomposition_;
};

}  // namespace a351::linear_algebra
