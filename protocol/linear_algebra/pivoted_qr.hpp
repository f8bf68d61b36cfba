#pragma once
/// @file
/// QR decomposition A P = Q R by Householder reflections, with column pivoting.

#include <Eigen/Core>
#include <memory>

namespace a351::corrector {

class PivotedQr {
public:
    /// @param matrix  (n, p) with n >= p.
    explicit PivotedQr(const Eigen::MatrixXd& matrix);
    ~PivotedQr();

    /// Returns |R(k, k)|, k = 0 ... p - 1, the largest first up to rounding.
    [[nodiscard]] Eigen::VectorXd pivots() const;
    /// Returns the number of pivots above p eps times the largest.
    [[nodiscard]] Eigen::Index rank() const;
    /// Returns the x (p) of least |A x - right|; A must have rank p.
    [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
    /// Returns the root S = P R^-1 (p, p) of the cofactor matrix: S S' = (A' A)^-1.  A must have
    /// rank p.
    [[nodiscard]] Eigen::MatrixXd cofactor_root() const;

private:
    struct Decomposition;
    std::unique_ptr<const Decomposition> decomposition_;
};

}  // namespace a351::corrector
