#pragma once
/// @file
/// Findings of a day about its unit, for another day of the same unit.
///
///     const UnitPosterior unit = unit_posterior(fit, priors);
///     const DayPriors next = unit.priors();     // of a later day

#include <Eigen/Core>

#include "corrector/whole_day/day_fit.hpp"

namespace a351::corrector::whole_day {

/// Response and axis biases of a unit with their joint covariance, and its noise.
struct UnitPosterior {
    Eigen::VectorXd values;      ///< In the order and units of unit_parameters().
    Eigen::MatrixXd covariance;  ///< Positive definite.
    DayNoise noise;              ///< Roots of the expected variances.

    /// Returns the usual priors with these parameters instead of those of another unit; the axis
    /// biases have a known size.
    [[nodiscard]] DayPriors priors() const;
};

/// Returns the posterior of a day's unit.
/// @param fit, priors  the priors are those of the fit.
[[nodiscard]] UnitPosterior unit_posterior(const DayFit& fit, const DayPriors& priors);

}  // namespace a351::corrector::whole_day
