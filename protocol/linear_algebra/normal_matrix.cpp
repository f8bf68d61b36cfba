#include "protocol/linear_algebra/normal_matrix.hpp"

namespace a351::linear_algebra {

Eigen::MatrixXd normal_matrix(const Eigen::Ref<const Eigen::MatrixXd>& columns) {
    Eigen::MatrixXd normal = columns.transpose() * columns;
    normal.diagonal().array() += 1.0;
    return normal;
}

}  // namespace a351::linear_algebra
