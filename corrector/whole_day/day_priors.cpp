#include "corrector/whole_day/day_priors.hpp"

#include <cmath>

#include "protocol/linear_algebra/cholesky.hpp"

namespace a351::corrector {

void DayPriors::observe(const std::vector<Eigen::Index>& places, const Eigen::VectorXd& values,
                        const Eigen::MatrixXd& covariance) {
    const Matrix before = factor * factor.transpose();
    const Eigen::MatrixXd innovation = before(places, places) + covariance;
    const Eigen::MatrixXd gain = Cholesky(innovation).solve(before(places, Eigen::all)).transpose();
    // K = P H' (H P H' + R)^-1
    mean += gain * (values - Eigen::VectorXd(mean(places)));
    // Joseph's form, P = (1 - K H) P (1 - K H)' + K R K': the result remains a covariance, however
    // exact the measurement is.
    Matrix left = Matrix::Identity();
    for (std::size_t k = 0; k < places.size(); ++k)
        left.col(places[k]) -= gain.col(static_cast<Eigen::Index>(k));
    const Matrix after = left * before * left.transpose() + gain * covariance * gain.transpose();
    factor = Cholesky(0.5 * (after + after.transpose())).lower();
}

// fit_day() lists the priors; corrector/methods.md gives their origin.
DayPriors usual_day_priors() {
    constexpr double kFreeDeviation_mgal = 1e4;
    constexpr double kLagFactor = 1.5;
    DayPriors priors;
    priors.mean << std::log(43.0), std::log(2700.0), 0.0, -12.0, -20.0, 11.3, 0.0, 0.0, 0.0, 0.0;
    DayPriors::Vector deviations;
    deviations << std::log(kLagFactor), std::log(kLagFactor), kFreeDeviation_mgal, 12.0, 20.0, 11.3,
        1.0, 36.0, 2000.0, 2000.0;
    priors.factor = deviations.asDiagonal();
    return priors;
}

}  // namespace a351::corrector
