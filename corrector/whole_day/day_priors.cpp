#include "corrector/whole_day/day_priors.hpp"

#include "protocol/linear_algebra/cholesky.hpp"

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

const std::vector<UnitParameter>& unit_parameters() {
    static const std::vector<UnitParameter> kList = [] {
        const auto name_of = [](unit::ThermalTerm lag) {
            return unit::kThermalNames.at(static_cast<std::size_t>(lag));
        };
        std::vector<UnitParameter> list{{name_of(unit::ThermalTerm::fast_lag), 0},
                                        {name_of(unit::ThermalTerm::slow_lag), 1}};
        for (Index k = 0; k < kTerms; ++k) {
            const adjustment::Term* const term = kDayTermList.at(static_cast<std::size_t>(k));
            if (term->scope == adjustment::Scope::unit && term != &adjustment::kScaleTerm)
                list.push_back({term->name, kLags + k});
        }
        return list;
    }();
    return kList;
}

DayPriors::Matrix DayPriors::factor_in(bool has_two_faces) const {
    constexpr double kSecant = 2.0 * 300.0 / kMilliGalPerStandardGravity;
    Matrix widened = factor;
    // The scale is the last term, so no other one is in its column.
    double& scale = widened(place_of(DayTerm::scale), place_of(DayTerm::scale));
    if (has_two_faces) scale = std::hypot(scale, kSecant);
    return widened;
}

// adjust_day() lists the priors; corrector/methods.md gives their origin.
DayPriors usual_day_priors() {
    constexpr double kDrift_mgal_per_h = 1.0, kBias_mgal_per_g = 300.0, kBiasFactor = 3.0;
    DayPriors priors;
    const auto set = [&priors](Index place, double mean, double deviation) {
        priors.mean(place) = mean;
        priors.factor(place, place) = deviation;
    };
    const auto set_thermal = [&set](Index place, unit::ThermalTerm term) {
        const unit::ThermalPrior prior = unit::day_prior(term);
        set(place, prior.mean, prior.deviation);
    };
    set_thermal(0, unit::ThermalTerm::fast_lag);
    set_thermal(1, unit::ThermalTerm::slow_lag);
    set_thermal(DayPriors::place_of(DayTerm::level), unit::ThermalTerm::level);
    set_thermal(DayPriors::place_of(DayTerm::slow), unit::ThermalTerm::slow);
    set_thermal(DayPriors::place_of(DayTerm::fast), unit::ThermalTerm::fast);
    set(DayPriors::place_of(DayTerm::constant), 0.0, kFreeGravity_mgal);
    set(DayPriors::place_of(DayTerm::drift), 0.0, kDrift_mgal_per_h);
    set(DayPriors::place_of(DayTerm::warm_up), 0.0, unit::kTypicalUnit.warm_up_mgal);
    set(DayPriors::place_of(DayTerm::x), 0.0, kBias_mgal_per_g);
    set(DayPriors::place_of(DayTerm::y), 0.0, kBias_mgal_per_g);
    set(DayPriors::place_of(DayTerm::scale), 0.0, unit::kUsualScaleDeviation);
    priors.bias_factor = kBiasFactor;
    return priors;
}

}  // namespace a351::corrector::whole_day
