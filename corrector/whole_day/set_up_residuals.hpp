#pragma once
/// @file
/// Residuals of the means of the set-ups in the whole-day model.
///
///     const auto residuals = set_up_residuals(record, stations, fit, priors);
///     residuals.direction(Eigen::VectorXd::Unit(n, 3));   // set-up 3 reads 1 mGal too high

#include <Eigen/Core>
#include <vector>

#include "corrector/residual/residuals.hpp"
#include "corrector/whole_day/day_model.hpp"

namespace a351::corrector::whole_day {

/// Returns the matrix (set-ups, bins) that averages bins over set-ups, weighted by their samples.
[[nodiscard]] Eigen::MatrixXd averaging(const reading::DayRecord& record, std::size_t set_ups);

/// Returns the residuals of the set-ups with the lags and the noise of a fit.
///
/// Unknown are the constant, unknown stations and steps.  The priors of all other terms, of the lags
/// to first order, and the expected noise are in the covariance.
/// @param record, stations, priors  as fit_day().
/// @param fit  fit of these stations, or of others: then lags, noise and coefficients are those.
[[nodiscard]] residual::Residuals set_up_residuals(const reading::DayRecord& record,
                                                   const std::vector<DayStation>& stations,
                                                   const DayFit& fit, const DayPriors& priors);

}  // namespace a351::corrector::whole_day
