#include "corrector/whole_day/unit_posterior.hpp"

#include <cmath>

#include "protocol/linear_algebra/cholesky.hpp"

namespace a351::corrector::whole_day {
namespace {

/// Places of the parameters in DayPriors.
const std::vector<Eigen::Index> kUnitPlaces{kFastLag,
                                            kSlowLag,
                                            DayPriors::place_of(DayTerm::level),
                                            DayPriors::place_of(DayTerm::slow),
                                            DayPriors::place_of(DayTerm::fast),
                                            DayPriors::place_of(DayTerm::x),
                                            DayPriors::place_of(DayTerm::y)};

}  // namespace

DayPriors UnitPosterior::priors() const {
    DayPriors priors = usual_day_priors();
    DayPriors::Matrix joint = priors.factor * priors.factor.transpose();
    for (std::size_t k = 0; k < kUnitPlaces.size(); ++k) {
        priors.mean(kUnitPlaces[k]) = values(static_cast<Eigen::Index>(k));
        for (std::size_t l = 0; l < kUnitPlaces.size(); ++l)
            joint(kUnitPlaces[k], kUnitPlaces[l]) =
                covariance(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(l));
    }
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
    unit.values = values(kUnitPlaces);
    unit.covariance = covariance(kUnitPlaces, kUnitPlaces);
    unit.noise = fit.expected_noise;
    return unit;
}

}  // namespace a351::corrector::whole_day
