#include "protocol/linear_algebra/cholesky.hpp"

#include <Eigen/Cholesky>
#include <stdexcept>
#include <utility>

namespace a351::linear_algebra {

Cholesky::Cholesky(Eigen::MatrixXd matrix) : factor_(std::move(matrix)) {
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> in_place(factor_);
    // Eigen accepts a pivot that is NaN as positive.
    is_positive_definite_ = in_place.info() == Eigen::Success && factor_.diagonal().allFinite();
}

const Eigen::MatrixXd& Cholesky::factor() const {
    if (!is_positive_definite_)
        throw std::invalid_argument("Cholesky: the matrix is not positive definite");
    return factor_;
}

Eigen::MatrixXd Cholesky::lower() const { return factor().triangularView<Eigen::Lower>(); }

double Cholesky::log_determinant() const { return 2.0 * factor().diagonal().array().log().sum(); }

Eigen::MatrixXd Cholesky::solve(const Eigen::MatrixXd& right) const {
    Eigen::MatrixXd solution = right;
    factor().triangularView<Eigen::Lower>().solveInPlace(solution);
    factor().triangularView<Eigen::Lower>().adjoint().solveInPlace(solution);
    return solution;
}

Eigen::VectorXd Cholesky::half_solve(Eigen::VectorXd right) const {
    factor().triangularView<Eigen::Lower>().solveInPlace(right);
    return right;
}

Eigen::MatrixXd Cholesky::inverse() const {
    return solve(Eigen::MatrixXd::Identity(factor_.rows(), factor_.cols()));
}

}  // namespace a351::linear_algebra
