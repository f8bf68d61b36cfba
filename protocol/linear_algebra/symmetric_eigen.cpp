#include "protocol/linear_algebra/symmetric_eigen.hpp"

#include <Eigen/Eigenvalues>

namespace a351::linear_algebra {

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
    return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace a351::linear_algebra
