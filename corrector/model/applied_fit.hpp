#pragma once
/// @file
/// A linear fit, applied to every row of a survey: what `paper` and the linear models share.
///
/// It is for models only; programs call correct_survey().  The order of calls matters, because each
/// one uses what the calls before it have set:
///
///     const auto applied = apply_model(terms, problem, choice, priors);
///     if (const auto* const refusal = std::get_if<Refusal>(&applied)) return *refusal;
///     const auto& fit = std::get<AppliedFit>(applied);
///     result.rows = uncorrected(problem, choice);
///     correct_rows(result, terms, fit);
///     result.stations = average_stations(result, choice.accepted, fit, fit.s_mgal);
///
/// All functions are pure, except that two of them set members of their first argument.

#include <Eigen/Core>
#include <optional>
#include <variant>
#include <vector>

#include "corrector/model/model.hpp"

namespace a351::corrector::model {

/// A fit with the regressors of all rows, in use or not.
///
/// `paper` uses only the regressors, leverages and the error of the slope.
struct AppliedFit {
    LinearFit fit;                 ///< Fit to the rows in use, in mGal.
    Eigen::MatrixXd columns;       ///< (n, p - 1) Regressors of all rows.
    std::optional<double> s_mgal;  ///< Standard deviation of a row; absent if dof = 0.

    /// Returns the regressors of a row (p - 1).
    /// @param row  number in SurveyProblem::rows, below n; not checked.
    [[nodiscard]] Eigen::VectorXd regressors_of(std::size_t row) const {
        return columns.row(static_cast<Eigen::Index>(row)).transpose();
    }
};

/// Fits a linear model to the rows in use.
///
/// Times count from SurveyProblem::origin().  The regressors are those of all rows, so that rows
/// outside the fit can be corrected too.
/// @param choice  each row in use has a reference.
/// @param priors  priors on the slopes; {} for none.
/// @return a refusal if they do not determine it.
/// @throws InputError  as model_columns().
[[nodiscard]] std::variant<AppliedFit, Refusal> apply_model(const LinearModel& model,
                                                            const SurveyProblem& problem,
                                                            const RowChoice& choice,
                                                            const Priors& priors);

/// Noise and residuals of a linear model, see Model::noise: standard deviation of a reading; readings
/// and priors in units of it.
[[nodiscard]] std::optional<Noise> linear_noise(const LinearModel& model,
                                                const ChosenSurvey& survey, const Noise* nearby);
[[nodiscard]] std::optional<residual::Residuals> linear_residuals(const LinearModel& model,
                                                                  const ChosenSurvey& survey,
                                                                  const Noise& noise);

/// Sets leverage and u_corrected = sqrt(s^2 + variance of the fit), that of a station that is not in
/// the fit.  Without priors it is s sqrt(1 + leverage).
///
/// Both are set for rows in the fit too.  For these u_corrected is larger than the error in sample.
/// @param row     number of the row in SurveyProblem::rows, the one from which `out` was made.
/// @param s_mgal  standard deviation of a row; without it there is no u_corrected.
void set_uncertainty(CorrectedRow& out, const AppliedFit& applied, std::size_t row,
                     std::optional<double> s_mgal);

/// Sets corrections, residuals, uncertainties and studentised residuals of all rows, and the
/// coefficients.
///
/// The constant b0 is part of the temperature correction, also in a model without temperature.  A
/// row without a reference has no residual.  Studentised residuals are those of least squares,
/// studentised_residual().  Score, stations and doubts are not set.
/// @param result  with the rows of uncorrected(), one per row of `applied`; coefficients are added
///                to those that it has.
/// @param model   model of the fit.
void correct_rows(Fit& result, const LinearModel& model, const AppliedFit& applied,
                  const Priors& priors);

/// Returns the values of the stations: means of their accepted rows, or of all their rows if none
/// is accepted.  u = sqrt(s^2 / n + variance of the fit at the mean of these rows); its factor for
/// 95 % is Student's with the degrees of freedom of the fit.
///
/// Stations are in the order of their first row, which also gives the reference.  The redundancy is
/// summed over the rows in the fit.  The part of the leverage remains with many rows, so u does not
/// go to 0.
/// @param result    after correct_rows(), or with corrected values and leverages of a model's own.
/// @param accepted  (n) RowChoice::accepted.
/// @param s_mgal    standard deviation of a row; without it there is no u.
[[nodiscard]] std::vector<StationValue> average_stations(const Fit& result,
                                                         const std::vector<bool>& accepted,
                                                         const AppliedFit& applied,
                                                         std::optional<double> s_mgal);

}  // namespace a351::corrector::model
