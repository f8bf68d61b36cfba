#pragma once
/// @file
/// Cholesky decomposition A = L L' of a symmetric positive definite matrix.

#include <Eigen/Core>

namespace a351::corrector {

/// All other members throw std::invalid_argument if the matrix is not positive definite.
class Cholesky {
public:
    /// @param matrix  (n, n) symmetric; only its lower triangle is read.
    explicit Cholesky(Eigen::MatrixXd matrix);

    /// Returns false if a pivot was not positive, or not a number.
    [[nodiscard]] bool is_positive_definite() const noexcept { return is_positive_definite_; }

    /// Returns L (n, n); the upper triangle is zero.
    [[nodiscard]] Eigen::MatrixXd lower() const;
    /// Returns ln det A.
    [[nodiscard]] double log_determinant() const;
    /// Returns the X (n, m) of A X = right.
    [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;
    /// Returns the x of L x = right: half of solve().
    [[nodiscard]] Eigen::VectorXd half_solve(Eigen::VectorXd right) const;
    [[nodiscard]] Eigen::MatrixXd inverse() const;

private:
    [[nodiscard]] const Eigen::MatrixXd& factor() const;

    Eigen::MatrixXd factor_;  ///< L in the lower triangle; the upper one is not used.
    bool is_positive_definite_ = false;
};

}  // namespace a351::corrector
