#pragma once
/// @file
/// Linear models of the difference between reading and gravity, fitted to stations of known
/// gravity:
///
///     D_i = b0 [+ bT (T_i - T0)] [+ bR R_i] [+ b1 (t_i - t0)] [+ bx x_i + by y_i]
///           [+ k (g_i - g0)] + noise,
///     D   = acceleration - g - tide
///
/// D is in mGal, T in degC, its rate R in degC/h, the time t in h, and x, y in g.
/// T0, t0 and g0 (980665 mGal) only shift the constant; they keep the numbers small.
/// k is the scale factor minus 1; with_scale() adds this term if the scale has a prior.
///
/// Use these models for one average per occupation.  For records use the whole-day model, which
/// knows the course of the temperature between the occupations.
///
///     const auto choice = choose_model(rows, origin, base);
///     const LinearModel& model = *find_linear_model(choice->model);
///     const auto fit = fit_model(model, rows, origin);           // fit->coefficients
///     const Score score = score_linear_model(model, rows, origin);
///
/// The same origin must be given to all calls for one survey, because it is part of t0.  All
/// functions are pure and deterministic.
///
/// Models, scores and choice: corrector/methods.md, "Linear models".

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/model/linear_fit.hpp"
#include "corrector/model/prior.hpp"
#include "corrector/reading/survey_row.hpp"

namespace a351::corrector::model {

/// T0, degC.  Reason: near the oven's set point.  The whole-day model has its own T0, 42.5 degC, so
/// the constants of both differ.
inline constexpr DegC kReferenceTemperature{42.6};
/// t0, h after the origin, which is the first row of a survey.  Reason: middle of a survey day.
inline constexpr double kReferenceTime_h = 5.0;

/// A step: an unknown offset of all readings of an instrument after an instant, for example after a
/// knock.
struct Step {
    UtcTime time;
    std::string instrument = {};  ///< SurveyRow::instrument; empty for the sensor.

    /// Returns true for a reading with the offset.
    [[nodiscard]] bool is_before(const reading::SurveyRow& row) const {
        return row.instrument == instrument && row.time > time;
    }
};

/// Where the times of a survey count from, and where its readings step.
struct TimeOrigin {
    UtcTime time;             ///< Instant at which t = 0.
    std::vector<Step> steps;  ///< In order of time.

    /// A survey without steps.
    TimeOrigin(UtcTime at) : time(at) {}  // NOLINT(google-explicit-constructor)
    TimeOrigin(UtcTime at, std::vector<Step> steps_at) : time(at), steps(std::move(steps_at)) {}
};

/// A linear model: its name and its terms besides the constant (linear_terms.hpp).
struct LinearModel {
    std::string_view name;         ///< Name in options and tables.
    bool has_temperature = false;  ///< Term bT (T - T0).
    bool has_rate = false;         ///< Term bR R.
    bool has_time = false;         ///< Term b1 (t - t0).
    bool has_axes = false;         ///< Terms bx x + by y: means of the horizontal axes; for tilt.
    bool has_scale = false;        ///< Term k (g - g0), always with a prior.

    /// Returns the number of coefficients p, the constant included.
    [[nodiscard]] std::size_t parameter_count() const;
};

/// Models from which `auto` chooses.  The list was fixed before any data were fitted.
///
/// - `t`: temperature only.  Use it for few rows.
/// - `t-rate`: and its rate, for a temperature that still changes during the occupations.
/// - `t-drift`: and time, for a drift of the instrument.
/// - `t-rate-drift`: all three.  `auto` takes it only as choose_model() says.
inline constexpr std::array<LinearModel, 4> kLinearModels{{
    {"t", true, false, false},
    {"t-rate", true, true, false},
    {"t-drift", true, false, true},
    {"t-rate-drift", true, true, true},
}};

/// Models that are fitted on request only.
///
/// - `t-rate-drift-axes`, for rows from records: the regressors of the whole-day model, as far as
///   means of occupations contain them.
/// - `drift`, for a box whose temperature hardly changes, or to compare with the other models.
inline constexpr std::array<LinearModel, 2> kModelsOnRequest{{
    {"t-rate-drift-axes", true, true, true, true},
    {"drift", false, false, true},
}};

/// Returns copies of the chosen rows, in their order.
/// @param chosen  (n) one flag per row; the number is not checked.
[[nodiscard]] std::vector<reading::SurveyRow> chosen_rows(
    const std::vector<reading::SurveyRow>& rows, const std::vector<bool>& chosen);

/// Returns the names of the rows' stations, in order of their first row.
[[nodiscard]] std::vector<std::string> station_names(const std::vector<reading::SurveyRow>& rows);

/// Returns the model of this name from kLinearModels or kModelsOnRequest; null if there is none.
[[nodiscard]] const LinearModel* find_linear_model(std::string_view name);

/// Returns the model with a term for the scale if the priors have one for it, else the model itself.
///
/// Without a calibration the term would gain nothing: a few known stations determine a scale far
/// less well than its usual prior, 1 +- 0.002.
[[nodiscard]] LinearModel with_scale(LinearModel model, const Priors& priors);

/// Returns the regressors of a model (n, p - 1): those of T - T0 (degC), R (degC/h), t - t0 (h), x
/// (g), y (g) and g - g0 (mGal) that it has, in this order; then for each step 1 after it and 0 before.
/// One row per survey row.  Without a reference g is the reading; apply_model() does better.
///
/// The columns are those of fit_linear().  A coefficient times its column is an effect in mGal,
/// which is subtracted from the reading.
/// @param rows    (n), also without reference; n may be 0.
/// @param origin  instant at which t = 0.
/// @throws InputError  if the model has axes and a row has no means of them.
[[nodiscard]] Eigen::MatrixXd model_columns(const LinearModel& model,
                                            const std::vector<reading::SurveyRow>& rows,
                                            const TimeOrigin& origin);

/// Returns the names of the coefficients with their units (p): the constant, then one per column.
///
/// They are the names of result.json, and those of kPriorNames where a prior is possible.  That of k
/// is `scale`; result.json has 1 + k.
/// @param steps  number of steps; their names are step_1_mgal and so on.
[[nodiscard]] std::vector<std::string> coefficient_names(const LinearModel& model,
                                                         std::size_t steps = 0);

/// Returns the priors on the slopes of a model, in the order of its columns (p - 1).  A weight is
/// reading_sd / sd; 0 for a slope without prior, and for steps.  Priors of terms that the model lacks
/// are ignored.
[[nodiscard]] SlopePriors slope_priors(const LinearModel& model, const Priors& priors,
                                       std::size_t steps = 0);

/// Fits a model to D (mGal) by fit_linear().
///
/// LinearFit::at() then returns the effect on a reading, mGal:
/// corrected = acceleration - tide - at(x), with x a row of model_columns().
///
/// Accuracy: a day made of temperature, rate and drift is explained within 1e-6 mGal rms, and only by
/// the model with all three (model_fit_test.cpp).
/// @param rows    (n) finite, each with a reference; NaN is not checked.
/// @param origin  instant at which t = 0.
/// @param priors  priors on the slopes; see slope_priors().
/// @return std::nullopt if there are no rows, or if rows and priors do not determine the model.
/// @throws InputError  as model_columns().
[[nodiscard]] std::optional<LinearFit> fit_model(const LinearModel& model,
                                                 const std::vector<reading::SurveyRow>& rows,
                                                 const TimeOrigin& origin,
                                                 const Priors& priors = {});

/// Root mean square errors of a model, mGal.  A score is absent if it is not defined for so few
/// rows, or for this model.
///
/// `rms_mgal` and `s_mgal` are in sample: the fit has seen these rows.  `loso_mgal` is the error to
/// expect at a station of unknown gravity; compare models by it.
struct Score {
    std::string model;                ///< Name of the model.
    std::size_t row_count = 0;        ///< Number of rows n.
    std::size_t parameter_count = 0;  ///< Number of coefficients p, steps included.
    /// Degrees of freedom of the residuals: n + rows of priors and datum - p.  `paper` and
    /// `day` have n - p, at least 0.
    std::size_t dof = 0;
    std::optional<double> rms_mgal;   ///< In sample, sqrt(RSS / n).
    std::optional<double> s_mgal;     ///< In sample, divisor dof instead of n.
    std::optional<double> loo_mgal;   ///< Leave-one-out: each row predicted without it.
    std::optional<double> loso_mgal;  ///< Each row predicted without the rows of its station.
    /// AICc = n ln(RSS/n) + 2K + 2K(K+1)/(n-K-1), K = p + 1 (C. M. Hurvich and C.-L. Tsai,
    /// Biometrika 76, 297-307, 1989).  Absent for a model with a prior, because p would then count
    /// too much.
    std::optional<double> aicc;
    std::optional<double> rms_before_drift_mgal;  ///< `paper` only: rms of Error (1).
};

/// Returns the scores of a linear model.
///
/// LOO uses r / (1 - h) with residual r and leverage h, which is exact for least squares.  LOSO
/// fits again without each station; it is absent if one of these fits is not determined.
///
/// s and LOO are absent if dof is 0.  AICc needs n > p + 2 and an RSS above 0.  Cost: one fit for
/// each station.
///
/// Accuracy: all scores of the eight reference regressions on the published rows agree within
/// 0.0005 (tests/golden/tsukuba_models_test.cpp).
/// @param rows    (n) rows of the fit, each with a reference.
/// @param origin  instant at which t = 0.
/// @param priors  priors on the slopes.
/// @return only row_count and parameter_count are set if the fit is not determined.
/// @throws InputError  as model_columns().
[[nodiscard]] Score score_linear_model(const LinearModel& model,
                                       const std::vector<reading::SurveyRow>& rows,
                                       const TimeOrigin& origin, const Priors& priors = {});

/// Returns the scores of the publication's correction (paper_correction.hpp).
///
/// The temperature line is fitted to the rows in use.  The ends of the drift are the first and the
/// last row of the base, in use or not.  p is 4.
///
/// LOSO is absent because the base cannot be left out.  AICc is absent because the correction is no
/// least-squares fit.  LOO leaves out each row in use in turn; without an end of the drift, the
/// next row of the base takes its place.
///
/// Accuracy: rms before and after the drift step, 2.0084 and 2.6249 mGal for the published rows,
/// agree within 0.0001 mGal (tests/golden/tsukuba_models_test.cpp).
/// @param rows    (n) in ascending time.
/// @param in_use  (n), true only for rows with a reference.
/// @param base    name of the base station.
/// @return rms_before_drift_mgal only if the drift step is refused; no score without a line.
[[nodiscard]] Score score_paper_model(const std::vector<reading::SurveyRow>& rows,
                                      const std::vector<bool>& in_use, std::string_view base);

/// Limits of a confidence interval, in the unit of the quantity.
struct Interval {
    double low = 0.0;   ///< Lower limit.
    double high = 0.0;  ///< Upper limit, at least `low`.
};

/// Number of bootstrap draws.  Reason: enough for the second digit of the limits.
inline constexpr int kBootstrapDraws = 1000;

/// Returns the 95 % bootstrap interval of the root mean square error sqrt(sum e^2 / n).
///
/// Each of kBootstrapDraws draws takes as many stations as there are, with replacement, and each
/// station with all its rows.  The limits are the 2.5 % and 97.5 % percentiles of the draws.
/// Stations and not rows are drawn, because rows of one station have an error in common.
/// The generator is std::mt19937_64: the same seed gives the same interval on any machine.
///
/// Accuracy: agrees with the normal approximation for 400 stations within 0.01, and for 100
/// stations of four rows each within 0.02, for an rms of 1.414 (bootstrap_test.cpp).
/// @param errors    (n) finite, any unit.
/// @param stations  (n) name of the station of each error.
/// @param seed      seed of the draws.
/// @return limits in the unit of the errors; std::nullopt for fewer than two different stations.
[[nodiscard]] std::optional<Interval> bootstrap_rms_interval(
    const std::vector<double>& errors, const std::vector<std::string>& stations,
    std::uint64_t seed);

/// Returns the 95 % bootstrap interval of a mean, drawn by station as in bootstrap_rms_interval().
///
/// For a paired comparison of two models give the differences of their squared errors.  Accuracy:
/// tested through bootstrap_rms_interval(), which takes the root of the interval of the squares.
/// @param values    (n) finite, any unit.
/// @param stations  (n) name of the station of each value.
/// @param seed      seed of the draws.
/// @return limits in the unit of the values; std::nullopt for fewer than two different stations.
[[nodiscard]] std::optional<Interval> bootstrap_mean_interval(
    const std::vector<double>& values, const std::vector<std::string>& stations,
    std::uint64_t seed);

/// Returns the error (mGal) of each row, predicted by a fit without the rows of its station.
///
/// Their rms is Score::loso_mgal, whose accuracy they have.
/// @param rows, origin, priors  as score_linear_model().
/// @return (n); std::nullopt if one of the fits is not determined.
[[nodiscard]] std::optional<std::vector<double>> left_out_errors_mgal(
    const LinearModel& model, const std::vector<reading::SurveyRow>& rows, const TimeOrigin& origin,
    const Priors& priors = {});

/// The model that was chosen, and the limit that it had to meet.
struct Choice {
    std::string model;        ///< Name of the model.
    double limit_mgal = 0.0;  ///< Least LOSO plus its standard error.
};

/// Least number of rows minus coefficients of a model that `auto` may choose.  Reason: s has then a
/// standard error of a third (1 / sqrt(2 x 5)), and a line does not follow single readings.
inline constexpr std::size_t kFewestChoiceDof = 5;

/// Least number of occupations of the base that separate drift from a bad reading.
inline constexpr std::size_t kFewestBaseStays = 3;

/// Chooses one of kLinearModels by its LOSO.
///
/// The limit is the least LOSO plus its standard error, LOSO / sqrt(2 (n - p)).  Among the models
/// within the limit, the one with the fewest terms is chosen, then the one with the smaller LOSO.
/// `t-rate-drift` takes part only with at least three occupations of the base or twelve rows.
///
/// The LOSO of the chosen model is too small as an error, because the model was chosen by it.  Use
/// choice_loso_mgal() as the error to expect.
/// @param rows    (n) rows of the fit, each with a reference.
/// @param origin  instant at which t = 0.
/// @param base    name of the base station.
/// @param priors  priors on the slopes.
/// @return std::nullopt if no model has a LOSO and kFewestChoiceDof more rows than coefficients.
[[nodiscard]] std::optional<Choice> choose_model(const std::vector<reading::SurveyRow>& rows,
                                                 const TimeOrigin& origin, std::string_view base,
                                                 const Priors& priors = {});

/// Returns the LOSO (mGal) of choosing and fitting together: the choice is repeated without each
/// station.  Absent if one of these choices or fits is impossible.
///
/// It is usually larger than the LOSO of the chosen model.  Cost: choose_model() once for each
/// station.
/// @param rows, origin, base, priors  as choose_model().
[[nodiscard]] std::optional<double> choice_loso_mgal(const std::vector<reading::SurveyRow>& rows,
                                                     const TimeOrigin& origin,
                                                     std::string_view base,
                                                     const Priors& priors = {});

}  // namespace a351::corrector::model
