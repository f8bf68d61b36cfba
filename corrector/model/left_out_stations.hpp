#pragma once
/// @file
/// Stations and differences of a linear model, predicted without their references.

#include "corrector/model/model.hpp"

namespace a351::corrector::model {

/// Sets left_out, u_left_out, dof and coverage_factor of the stations, all differences and the
/// covariance.
///
/// A value is that of the fit to the rows of the other stations, a difference that of the fit
/// without both stations: d = mean(D)_to - mean(D)_from - (x_to - x_from)' b, with
/// u^2 = s^2 (1/n_from + 1/n_to + (x_to - x_from)' C (x_to - x_from)).  x are mean regressors, n
/// numbers of rows, and C is the cofactor of the slopes b.  The coverage factor is Student's for
/// 95 %.  The covariance is that of StationValue::gravity as if the stations were not in the fit.
///
/// A pair without which the rows do not determine the model is left out.  Cost: one fit for each
/// pair.
/// @param result  with corrected rows and stations.
void set_left_out_stations(Fit& result, const LinearModel& terms, const SurveyProblem& problem,
                           const RowChoice& choice);

}  // namespace a351::corrector::model
