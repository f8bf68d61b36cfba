#include "corrector/whole_day/day_priors.hpp"

#include "protocol/linear_algebra/cholesky.hpp"
#include "protocol/unit/calibration.hpp"
#include "protocol/unit/thermal_response.hpp"

namespace a351::corrector::whole_day {

using Index = Eigen::Index;

void DayPriors::observe(const std::vector<Eigen::Index>& places, const Eigen::VectorXd& values,
                        const Eigen::MatrixXd& covariance) {
    const Matrix before = factor * factor.transpose();
    const Eigen::MatrixXd innovation = before(places, places) + covariance;
    const Eigen::MatrixXd gain =
        linear_algebra::Cholesky(innovation).solve(before(places, Eigen::all)).transpose();
    // K = P H' (H P H' + R)^-1
    mean += gain * (values - Eigen::VectorXd(mean(places)));
    // Joseph's form, P = (1 - K H) P (1 - K H)' + K R K': the result remains a covariance, however
    // exact the measurement is.
    Matrix left = Matrix::Identity();
    for (std::size_t k = 0; k < places.size(); ++k)
        left.col(places[k]) -= gain.col(static_cast<Eigen::Index>(k));
    const Matrix after = left * before * left.transpose() + gain * covariance * gain.transpose();
    factor = linear_algebra::Cholesky(0.5 * (after + after.transpose())).lower();
}

void DayPriors::free_axes() {
    // The data sheet's initial bias error is +-2 mg.
    constexpr double kGreatestBias_mgal_per_g = 2000.0;
    for (const Index place : {place_of(DayTerm::x), place_of(DayTerm::y)}) {
        factor.row(place).setZero();
        factor(place, place) = kGreatestBias_mgal_per_g;
    }
    bias_factor = 1.0;
}

void DayPriors::set_scale(double value, double deviation) {
    const Index place = place_of(DayTerm::scale);
    mean(place) = value - 1.0;
    factor.row(place).setZero();
    factor.col(place).setZero();
    factor(place, place) = deviation;
}

// adjust_day() lists the priors; corrector/methods.md gives their origin.
DayPriors usual_day_priors() {
    constexpr double kDrift_mgal_per_h = 1.0, kBias_mgal_per_g = 300.0, kBiasFactor = 3.0;
    const unit::ThermalPrior fast_lag = unit::day_prior(unit::ThermalTerm::fast_lag),
                             slow_lag = unit::day_prior(unit::ThermalTerm::slow_lag),
                             level = unit::day_prior(unit::ThermalTerm::level),
                             slow = unit::day_prior(unit::ThermalTerm::slow),
                             fast = unit::day_prior(unit::ThermalTerm::fast);
    DayPriors priors;
    priors.mean << fast_lag.mean, slow_lag.mean, 0.0, level.mean, slow.mean, fast.mean, 0.0, 0.0,
        0.0, 0.0, 0.0;
    DayPriors::Vector deviations;
    deviations << fast_lag.deviation, slow_lag.deviation, kFreeGravity_mgal, level.deviation,
        slow.deviation, fast.deviation, kDrift_mgal_per_h, unit::kTypicalUnit.warm_up_mgal,
        kBias_mgal_per_g, kBias_mgal_per_g, unit::kUsualScaleDeviation;
    priors.factor = deviations.asDiagonal();
    priors.bias_factor = kBiasFactor;
    return priors;
}

}  // namespace a351::corrector::whole_day
