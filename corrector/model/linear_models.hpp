#pragma once
/// @file
/// Linear models of single readings: lists of terms, their scores, and the choice among them.
///
///     D_i = reading_i - reference_i - tide_i = sum over the terms of coefficient x column + noise
///
/// References are exact, the noise is white, and the readings of the stations with a reference
/// determine it.  A prior of a coefficient has the weight of a reading of
/// Priors::reading_sd_mgal.  The adjustment is that of corrector/adjustment.
///
/// Methods: corrector/methods.md, "Linear models".

#include <optional>
#include <vector>

#include "corrector/adjustment/survey_equations.hpp"
#include "corrector/model/model.hpp"

namespace a351::corrector::model {

/// A linear model: its name and its terms.
struct LinearModel {
    std::string_view name;  ///< Name in options and tables.
    std::vector<const adjustment::Term*> terms;
};

/// Returns the models from which `auto` chooses.  The list was fixed before any data were fitted.
///
/// - `t`: temperature only.  Use it for few rows.
/// - `t-rate`: and its rate, for a temperature that still changes during the occupations.
/// - `t-drift`: and time, for a drift of the instrument.
/// - `t-rate-drift`: all three.  `auto` takes it only as choose_model() says.
[[nodiscard]] const std::vector<LinearModel>& compared_models();

/// Returns the models that are fitted on request only.
///
/// - `t-rate-drift-axes`, for rows from records: the regressors of the whole-day model, as far as
///   means of occupations contain them.
/// - `drift`, for a box whose temperature hardly changes, or to compare with the other models.
[[nodiscard]] const std::vector<LinearModel>& models_on_request();

/// Returns the model of this name; null if there is none.
[[nodiscard]] const LinearModel* find_linear_model(std::string_view name);

/// Returns the adjustment of the rows in use.
///
/// The scale is a term only if it has a prior: a few known stations determine a scale far less well
/// than its usual prior, 1 +- 0.002, so that the term would gain nothing.
/// @param in_use  (n) each of them has a reference.
/// @throws InputError  the model has axes and a row has no means of them.
[[nodiscard]] adjustment::AdjustedSurvey adjust_linear(const LinearModel& model,
                                                       const SurveyProblem& problem,
                                                       const std::vector<bool>& in_use);

/// Returns the scores of a linear model.
///
/// LOO uses r / (1 - h) with residual r and leverage h, which is exact for least squares.  LOSO
/// adjusts again without each station; it is absent if one of these adjustments is not determined.
///
/// s and LOO are absent if dof is 0.  AICc needs n > p + 2 and an RSS above 0.
///
/// Accuracy: all scores of the eight reference regressions on the published rows agree within
/// 0.0005 (tests/golden/tsukuba_models_test.cpp).
/// @return only row_count and parameter_count are set if the adjustment is not determined.
/// @throws InputError  as adjust_linear().
[[nodiscard]] Score score_linear_model(const LinearModel& model, const SurveyProblem& problem,
                                       const std::vector<bool>& in_use);

/// Returns the error (mGal) of each row in use, predicted without the rows of its station; their rms
/// is Score::loso_mgal.
/// @return one for each row in use; std::nullopt if one of the adjustments is not determined.
[[nodiscard]] std::optional<std::vector<double>> left_out_errors_mgal(
    const LinearModel& model, const SurveyProblem& problem, const std::vector<bool>& in_use);

/// Least number of rows minus coefficients of a model that `auto` may choose.  Reason: s has then a
/// standard error of a third (1 / sqrt(2 x 5)), and a line does not follow single readings.
inline constexpr std::size_t kFewestChoiceDof = 5;

/// Least number of occupations of the base that separate drift from a bad reading.
inline constexpr std::size_t kFewestBaseStays = 3;

/// Chooses one of compared_models() by its LOSO.
///
/// The limit is the least LOSO plus its standard error, LOSO / sqrt(2 (n - p)).  Among the models
/// within the limit, the one with the fewest terms is chosen, then the one with the smaller LOSO.
/// `t-rate-drift` takes part only with at least three occupations of the base or twelve rows.
///
/// The LOSO of the chosen model is too small as an error, because the model was chosen by it.  Use
/// choice_loso_mgal() as the error to expect.
/// @return std::nullopt if no model has a LOSO and kFewestChoiceDof more rows than coefficients.
[[nodiscard]] std::optional<Choice> choose_model(const SurveyProblem& problem,
                                                 const std::vector<bool>& in_use);

/// Returns the LOSO (mGal) of choosing and fitting together: the choice is repeated without each
/// station.  Absent if one of these choices or fits is impossible.
///
/// It is usually larger than the LOSO of the chosen model.  Cost: choose_model() once for each
/// station.
[[nodiscard]] std::optional<double> choice_loso_mgal(const SurveyProblem& problem,
                                                     const std::vector<bool>& in_use);

}  // namespace a351::corrector::model
