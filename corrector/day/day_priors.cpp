#include "corrector/day/day_priors.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace a351::corrector {

void DayPriors::observe(const std::vector<Eigen::Index>& places, const Eigen::VectorXd& values,
                        const Eigen::MatrixXd& covariance) {
    const Matrix before = factor * factor.transpose();
    const Eigen::MatrixXd innovation = before(places, places) + covariance;
    const Eigen::MatrixXd gain =
        innovation.llt().solve(Eigen::MatrixXd(before(places, Eigen::all))).transpose();
    mean += gain * (values - Eigen::VectorXd(mean(places)));
    const Matrix after = before - gain * before(places, Eigen::all);
    factor = Matrix(0.5 * (after + after.transpose())).llt().matrixL();
}

// fit_day() documents the priors, methods.md where they come from.
DayPriors usual_day_priors() {
    constexpr double kAnything_mgal = 1e4;
    constexpr double kLagFactor = 1.5;
    DayPriors priors;
    priors.mean << std::log(43.0), std::log(2700.0), 0.0, -12.0, -20.0, 11.3, 0.0, 0.0, 0.0, 0.0;
    DayPriors::Vector deviations;
    deviations << std::log(kLagFactor), std::log(kLagFactor), kAnything_mgal, 12.0, 20.0, 11.3, 1.0,
        36.0, 2000.0, 2000.0;
    priors.factor = deviations.asDiagonal();
    return priors;
}

}  // namespace a351::corrector
