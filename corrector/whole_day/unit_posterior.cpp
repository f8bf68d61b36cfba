#include "corrector/whole_day/unit_posterior.hpp"

#include <cmath>
#include <vector>

#include "protocol/linear_algebra/cholesky.hpp"

namespace a351::corrector::whole_day {
namespace {

/// Returns the places of the parameters in DayPriors.
std::vector<Eigen::Index> places_of_unit() {
    std::vector<Eigen::Index> places;
    for (const UnitParameter& parameter : unit_parameters()) places.push_back(parameter.place);
    return places;
}

}  // namespace

DayPriors UnitPosterior::priors() const {
    DayPriors priors = usual_day_priors();
    DayPriors::Matrix joint = priors.factor * priors.factor.transpose();
    const std::vector<Eigen::Index> places = places_of_unit();
    priors.mean(places) = values;
    joint(places, places) = covariance;
    priors.factor = linear_algebra::Cholesky(joint).lower();
    priors.bias_factor = 1.0;
    return priors;
}

UnitPosterior unit_posterior(const DayFit& fit, const DayPriors& priors) {
    DayPriors::Matrix factor = priors.factor;
    for (const DayTerm axis : {DayTerm::x, DayTerm::y})
        factor.row(DayPriors::place_of(axis)) *=
            std::pow(priors.bias_factor, fit.expected[kBiasSize]);
    const DayPriors::Matrix covariance = factor * fit.shift_covariance * factor.transpose();
    DayPriors::Vector values;
    values << std::log(fit.fast_lag_s), std::log(fit.slow_lag_s),
        DayPriors::Vector::Zero().tail<kTerms>();
    for (std::size_t k = 0; k < kDayTerms; ++k)
        values(DayPriors::place_of(static_cast<DayTerm>(k))) = fit.coefficients.at(k).value;
    UnitPosterior unit;
    const std::vector<Eigen::Index> places = places_of_unit();
    unit.values = values(places);
    unit.covariance = covariance(places, places);
    unit.noise = fit.expected_noise;
    return unit;
}

}  // namespace a351::corrector::whole_day
