#pragma once
/// @file
/// From an adjusted survey to the fit of a model: corrected rows, coefficients, stations.
///
/// It serves every model with white noise: linear models, whose references are exact and whose noise is
/// estimated, and the network, whose references have an uncertainty and whose noise is stated.
///
///     Fit fit = fit_of(adjusted, problem, choice);
///     fit.score = ...;

#include <functional>
#include <string>

#include "corrector/adjustment/survey_equations.hpp"
#include "corrector/model/model.hpp"

namespace a351::corrector::model {

/// Returns corrected rows, coefficients, scales and stations; no score.
///
/// - A row's u_corrected is sqrt(sd^2 + variance of its corrections), as if its station were unknown.
///   Its leverage is 1 - redundancy, and outside the fit the variance of its corrections / sd^2.
/// - A station that is an unknown has its adjusted value; another one the mean of its accepted rows,
///   or of all its rows if none is accepted, with u^2 = sd^2 / n + variance of the mean correction.
/// - Exact references: sd is estimated, s = s0 reading_sd; factors for 95 % are Student's.
/// - Uncertain references: sd is stated, and the model sets the factors (network.cpp).
///
/// A row whose loop has no reading in use has no corrections.
[[nodiscard]] Fit fit_of(const adjustment::AdjustedSurvey& adjusted, const SurveyProblem& problem,
                         const RowChoice& choice);

/// Sets the 95 % limits of LOO from the errors r / (1 - h).
void set_loo_interval(Fit& result, std::uint64_t seed);

/// Sets left_out and u_left_out of the stations, all differences and the covariance, of a model with
/// exact references.
///
/// A value is that of the fit to the rows of the other stations, a difference that of the fit
/// without both stations: d = mean(D)_to - mean(D)_from - (x_to - x_from)' b, with
/// u^2 = s^2 (1/n_from + 1/n_to) + (x_to - x_from)' V (x_to - x_from).  x are mean regressors, n
/// numbers of rows, s is that of the fit to all rows, and V is the covariance of the coefficients b.
/// The covariance is that of StationValue::gravity as if the stations were not in the fit.
///
/// A pair without which the rows do not determine the model is left out.
/// @param without  returns the adjustment without the rows of two stations, which may be the same.
void set_left_out_stations(
    Fit& result, const adjustment::AdjustedSurvey& adjusted, const RowChoice& choice,
    const std::function<adjustment::AdjustedSurvey(const std::string&, const std::string&)>&
        without);

/// Sets left_out and u_left_out of the stations, all differences and the covariance, of a model with
/// uncertain references: a station is left out by hiding its reference, v / r of its row.  Differences and
/// covariance keep all references.
void set_hidden_references(Fit& result, const adjustment::AdjustedSurvey& adjusted);

}  // namespace a351::corrector::model
