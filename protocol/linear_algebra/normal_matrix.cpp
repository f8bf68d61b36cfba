#include "protocol/linear_algebra/normal_matrix.hpp"

#include <cmath>

#include "protocol/linear_algebra/cholesky.hpp"

namespace a351::linear_algebra {

Eigen::MatrixXd normal_matrix(const Eigen::Ref<const Eigen::MatrixXd>& columns) {
    Eigen::MatrixXd normal = columns.transpose() * columns;
    normal.diagonal().array() += 1.0;
    return normal;
}

double marginal_cost(const Eigen::Ref<const Eigen::MatrixXd>& columns,
                     const Eigen::Ref<const Eigen::VectorXd>& readings) {
    const Cholesky factor(normal_matrix(columns));
    if (!factor.is_positive_definite()) return HUGE_VAL;
    const Eigen::VectorXd half = factor.half_solve(columns.transpose() * readings);
    return factor.log_determinant() + readings.squaredNorm() - half.squaredNorm();
}

}  // namespace a351::linear_algebra
