#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "protocol/linear_algebra/cholesky.hpp"
#include "protocol/linear_algebra/normal_matrix.hpp"
#include "protocol/linear_algebra/pivoted_qr.hpp"
#include "protocol/linear_algebra/symmetric_eigen.hpp"
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::linear_algebra;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Eigen::MatrixXd symmetric() {
    Eigen::MatrixXd matrix(3, 3);
    matrix << 4.0, 2.0, 0.4, 2.0, 5.0, 1.0, 0.4, 1.0, 3.0;
    return matrix;
}

/// Returns a matrix with columns of unequal size, so that pivoting changes their order.
Eigen::MatrixXd design() {
    Eigen::MatrixXd matrix(4, 2);
    matrix << 1.0, 10.0, 1.0, 20.0, 1.0, 40.0, 1.0, 80.0;
    return matrix;
}

}  // namespace

TEST_CASE("a Cholesky decomposition reproduces the matrix, its solutions and its determinant") {
    const Cholesky factor(symmetric());
    REQUIRE(factor.is_positive_definite());
    CHECK((factor.lower() * factor.lower().transpose() - symmetric()).norm() < 1e-14);
    CHECK((symmetric() * factor.inverse() - Eigen::MatrixXd::Identity(3, 3)).norm() < 1e-14);
    const Eigen::Vector3d right(1.0, -2.0, 3.0);
    CHECK((symmetric() * factor.solve(right) - right).norm() < 1e-14);
    CHECK((factor.lower() * factor.half_solve(right) - right).norm() < 1e-14);
    // 4 (5 * 3 - 1) - 2 (2 * 3 - 0.4) + 0.4 (2 - 0.4 * 5)
    CHECK(factor.log_determinant() == Approx(std::log(44.8)).epsilon(1e-14));
}

TEST_CASE("a matrix that is not positive definite, or contains a NaN, is refused") {
    for (const auto& [row, column, value] :
         {std::tuple{1, 1, -5.0}, std::tuple{2, 2, kNan}, std::tuple{2, 0, kNan}}) {
        Eigen::MatrixXd matrix = symmetric();
        matrix(row, column) = value;
        const Cholesky factor(matrix);
        CHECK_FALSE(factor.is_positive_definite());
        CHECK_THROWS_AS(factor.solve(symmetric()), std::invalid_argument);
        CHECK_THROWS_AS(factor.log_determinant(), std::invalid_argument);
    }
}

TEST_CASE(
    "a pivoted QR decomposition solves least squares and gives the square root of the cofactor") {
    const PivotedQr qr(design());
    CHECK(qr.rank() == 2);
    CHECK(qr.pivots()(0) >= qr.pivots()(1));
    const Eigen::Vector4d right(3.0, 5.0, 9.0, 17.0);  // 1 + 0.2 x
    CHECK((qr.solve(right) - Eigen::Vector2d(1.0, 0.2)).norm() < 1e-13);
    const Eigen::MatrixXd normal = design().transpose() * design();
    const Eigen::MatrixXd cofactor = qr.cofactor_root() * qr.cofactor_root().transpose();
    CHECK((normal * cofactor - Eigen::MatrixXd::Identity(2, 2)).norm() < 1e-10);

    Eigen::MatrixXd alike = design();
    alike.col(1) = 3.0 * alike.col(0);
    CHECK(PivotedQr(alike).rank() == 1);
}

TEST_CASE("eigenvalues are in ascending order and match their eigenvectors") {
    const SymmetricEigen axes = symmetric_eigen(symmetric());
    for (Eigen::Index k = 0; k < 3; ++k) {
        CHECK((symmetric() * axes.vectors.col(k) - axes.values(k) * axes.vectors.col(k)).norm() <
              1e-13);
        if (k > 0) CHECK(axes.values(k) >= axes.values(k - 1));
    }
}

TEST_CASE("a normal matrix includes a unit prior for each unknown on its diagonal") {
    const Eigen::MatrixXd excess = normal_matrix(design()) - design().transpose() * design();
    CHECK((excess - Eigen::MatrixXd::Identity(2, 2)).norm() < 1e-11);
}

TEST_CASE("the marginal cost is that of readings with noise and priors in one covariance") {
    const Eigen::Vector4d readings(3.0, -1.0, 2.0, 0.5);
    const Eigen::MatrixXd x = 0.01 * design();
    const Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(4, 4) + x * x.transpose();
    const Cholesky factor(covariance);
    const double expected = factor.log_determinant() + readings.dot(factor.solve(readings).col(0));
    CHECK(marginal_cost(x, readings) == Approx(expected).epsilon(1e-12));
    CHECK(marginal_cost(Eigen::MatrixXd::Constant(4, 2, 1e200), readings) == HUGE_VAL);
}
