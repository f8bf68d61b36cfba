#pragma once
/// @file
/// Linear models of what the sensor reads beyond gravity, fitted to known stations:
///
///     D_i = b0 [+ bT (T_i - T0)] [+ bR R_i] [+ b1 (t_i - t0)] [+ bx x_i + by y_i] + noise,
///     D = acceleration - g - tide
///
/// T0 and t0 only shift the constant; they keep the numbers small.

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/model/linear_fit.hpp"
#include "corrector/model/prior.hpp"
#include "corrector/reading/survey_row.hpp"

namespace a351::corrector {

inline constexpr DegC kReferenceTemperature{42.6};  ///< T0, near the oven's set point.
inline constexpr double kReferenceTime_h = 5.0;     ///< t0, after the first row: mid-day.

struct LinearModel {
    std::string_view name;
    bool has_temperature = false;
    bool has_rate = false;
    bool has_time = false;
    bool has_axes = false;  ///< x, y: means of the horizontal axes, which a tilt brings in.

    [[nodiscard]] std::size_t parameter_count() const {
        return 1U + (has_temperature ? 1U : 0U) + (has_rate ? 1U : 0U) + (has_time ? 1U : 0U) +
               (has_axes ? 2U : 0U);
    }
};

/// The models that `auto` chooses from, fixed beforehand.
inline constexpr std::array<LinearModel, 4> kLinearModels{{
    {"t", true, false, false},
    {"t-rate", true, true, false},
    {"t-drift", true, false, true},
    {"t-rate-drift", true, true, true},
}};

/// Models that are fitted on request only.  With axes, for rows from records: the whole-day model's
/// regressors as far as means of occupations have them.  Drift alone, for a box whose temperature
/// hardly changes, or to see what the other terms bring.
inline constexpr std::array<LinearModel, 2> kModelsOnRequest{{
    {"t-rate-drift-axes", true, true, true, true},
    {"drift", false, false, true},
}};

/// Null when the name is in neither list.
[[nodiscard]] const LinearModel* find_linear_model(std::string_view name);

/// Columns of the model (those of T - T0, R, t - t0, x, y that it has), one row per survey row.
/// @param origin  instant from which t counts.
/// @throws InputError  the model has axes and a row has no means of them.
[[nodiscard]] Eigen::MatrixXd model_columns(const LinearModel& model,
                                            const std::vector<SurveyRow>& rows, UtcTime origin);

/// Names of the coefficients with their units: the constant, then one per column.
[[nodiscard]] std::vector<std::string> coefficient_names(const LinearModel& model);

/// Priors on the slopes of a model, in its order.
[[nodiscard]] SlopePriors slope_priors(const LinearModel& model, const ModelPriors& priors);

/// @param rows  each with a reference.
/// @return std::nullopt when they and the priors do not determine the model.
[[nodiscard]] std::optional<LinearFit> fit_model(const LinearModel& model,
                                                 const std::vector<SurveyRow>& rows, UtcTime origin,
                                                 const ModelPriors& priors = {});

/// Root mean square errors in mGal.  Absent: not defined for so few rows, or for this model.
struct ModelScore {
    std::string model;
    std::size_t row_count = 0;        ///< n
    std::size_t parameter_count = 0;  ///< p
    /// Degrees of freedom of the residuals: n, priors and datum counted in, less p.
    std::size_t dof = 0;
    std::optional<double> rms_mgal;   ///< In sample, divisor n.
    std::optional<double> s_mgal;     ///< In sample, divisor dof.
    std::optional<double> loo_mgal;   ///< Each row predicted without it.
    std::optional<double> loso_mgal;  ///< Each row predicted without the rows of its station.
    /// n ln(rss/n) + 2K + 2K(K+1)/(n-K-1), K = p + 1.  Not for a model with a prior, where p would
    /// count too much.
    std::optional<double> aicc;
    std::optional<double> rms_before_drift_mgal;  ///< `paper` only: of Error (1).
};

/// @param rows  those of the fit, each with a reference.
[[nodiscard]] ModelScore score_linear_model(const LinearModel& model,
                                            const std::vector<SurveyRow>& rows, UtcTime origin,
                                            const ModelPriors& priors = {});

/// The publication's chain, line from the rows in use, ends of the drift from all of the base.
/// Without LOSO (the base cannot be left out) and AICc (it is not a least-squares fit).  LOO takes
/// each row in use away; the next one of the base stands in for an end.
/// @param in_use  one per row, true only for rows with a reference.
[[nodiscard]] ModelScore score_paper_model(const std::vector<SurveyRow>& rows,
                                           const std::vector<bool>& in_use, std::string_view base);

/// Among the models within one standard error of the least LOSO, LOSO / sqrt(2 (n - p)), the one
/// with the fewest terms, then with the lesser LOSO.  `t-rate-drift` takes part only with at least
/// three rows of the base or twelve in all.
/// @return the name; std::nullopt when no model has a LOSO.
struct ModelChoice {
    std::string model;
    double limit_mgal = 0.0;  ///< Best LOSO plus one standard error.
};
[[nodiscard]] std::optional<ModelChoice> choose_model(const std::vector<SurveyRow>& rows,
                                                      UtcTime origin, std::string_view base,
                                                      const ModelPriors& priors = {});

/// LOSO of the procedure: the choice repeated without each station.
[[nodiscard]] std::optional<double> choice_loso_mgal(const std::vector<SurveyRow>& rows,
                                                     UtcTime origin, std::string_view base,
                                                     const ModelPriors& priors = {});

}  // namespace a351::corrector
