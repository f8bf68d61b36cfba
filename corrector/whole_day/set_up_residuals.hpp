#pragma once
/// @file
/// Residuals of the means of the set-ups in the whole-day model.
///
///     const auto residuals = set_up_residuals(survey, fit, NoiseCovariance(bins));
///     residuals.direction(Eigen::VectorXd::Unit(n, 3));   // set-up 3 reads 1 mGal too high

#include <Eigen/Core>

#include "corrector/adjustment/dense_residuals.hpp"
#include "corrector/whole_day/day_fit.hpp"
#include "corrector/whole_day/day_noise.hpp"
#include "corrector/whole_day/day_survey.hpp"

namespace a351::corrector::whole_day {

/// Returns the matrix (set-ups, bins) that averages bins over set-ups, weighted by their samples.
/// Each row adds up to 1; the row of a set-up without a bin is NaN.
[[nodiscard]] Eigen::MatrixXd averaging(const reading::DayRecord& record, std::size_t set_ups);

/// Returns the residuals of the set-ups with the lags and the noise of a fit.
///
///     r = W M (y - prior expectation) without its part in the unknowns,   W' W = C^-1
///     C = M N M' + sum of x x' over the terms with a prior and over both lags
///
/// M is averaging(), y the bins, N their NoiseCovariance with the expected noise, x a column of a
/// term or a lag (to first order) times the deviation of its prior.  Unknowns are the constant,
/// unknown stations and steps.
///
/// Accuracy: no test of its own; goodness_of_fit_test.cpp and mistake_search_test.cpp find misfits
/// and mistakes of known size in these residuals.  Cost: O(bins^2 + set-ups^3).
/// @param survey  finite, each set-up has a bin.
/// @param fit  fit of these stations, or of others: then lags, noise and coefficients are those.
/// @param covariance_of_bins  of the bins of the survey's record.
[[nodiscard]] adjustment::DenseResiduals set_up_residuals(
    const DaySurvey& survey, const DayFit& fit, const NoiseCovariance& covariance_of_bins);

}  // namespace a351::corrector::whole_day
