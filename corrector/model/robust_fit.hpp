#pragma once
/// @file
/// MM estimation of a linear model: the influence of bad rows is bounded, however large they are.
///
/// Use it to look for bad rows, above all if several of them may hide each other.  Do not use it
/// for few rows: with n close to p the weights mean little.  Nearly half of the rows may be bad,
/// not more.
///
///     const auto robust = fit_robust(columns, y);
///     if (!robust) return;
///     robust->weights;                                        // near 0: bad row
///     robust->s * std::sqrt(robust->fit.cofactor(1, 1));      // standard error of the first slope
///
/// All functions are pure: they use a generator of their own with a fixed seed.
///
/// Sources: P. J. Rousseeuw and A. M. Leroy, Robust regression and outlier detection, Wiley 1987
/// (start and scale); V. J. Yohai, Ann. Statist. 15, 642-656, 1987 (MM); P. J. Huber, Robust
/// statistics, Wiley 1981, 7.6 (covariance).

#include <optional>

#include "corrector/model/model_fit.hpp"

namespace a351::corrector::model {

/// Tuning constant c of the bisquare, in units of the scale.  Reason: 95 % efficient for normal
/// errors.
inline constexpr double kBisquareTuning = 4.685;

/// Result of a robust fit with n rows.
///
/// LinearFit::at() is robust; cofactor, leverages, r_squared and prior_rss are those of least
/// squares.  Use `s` and not LinearFit::residual_scale(), which would count bad rows fully.
struct RobustFit {
    LinearFit fit;             ///< Coefficients and residuals are robust; cofactor of all rows.
    Eigen::VectorXd weights;   ///< (n) Bisquare weights: 1 fully counted, 0 not at all.
    double start_scale = 0.0;  ///< Scale of the start, unit of y; a weight is 0 beyond 4.685 of it.
    /// Standard deviation of a row, unit of y; s^2 times the cofactor is the covariance.
    double s = 0.0;
};

/// Fits y = b0 + X b robustly, with n rows and p coefficients.
///
/// 1. Start: least trimmed squares, the smallest sum of the h = (n + p + 1) / 2 smallest r^2.
///    It is searched over all subsets of p rows for n <= 25, else over 3000 subsets from a fixed
///    seed.  The ten best are concentrated.
/// 2. Scale: 1.4826 (1 + 5 / (n - p)) median |r| of the start, at least 1e-6; it is then kept.
/// 3. Weights (1 - u^2)^2 for |u| < 1, else 0, with u = r / (c scale).  They are iterated until no
///    fitted value changes by 1e-9, at most 200 times.
/// 4. s^2 = K^2 sum psi^2 / (n - p) / mean(psi')^2, with psi = weight x r and
///    K = 1 + p / n var(psi') / mean(psi')^2.
///
/// Cost: up to 12650 small systems for four coefficients and 25 rows, or 3000 for more rows, before
/// the iteration.
///
/// The result is deterministic.  Accuracy (robust_fit_test.cpp): without bad rows the slope is
/// within half a standard error of least squares and s within 20 %.  A third of the rows, shifted
/// by 25 in the same direction (noise 0.5), get weight 0.
/// @param columns  X (n, p - 1), finite.
/// @param y        (n) finite.
/// @param priors   priors on the slopes; their rows always have full weight.
/// @return std::nullopt for n <= p, if rows and priors do not determine the coefficients, or if the
///         rows with weight do not determine them during the iteration.
[[nodiscard]] std::optional<RobustFit> fit_robust(const Eigen::Ref<const Eigen::MatrixXd>& columns,
                                                  const Eigen::Ref<const Eigen::VectorXd>& y,
                                                  const SlopePriors& priors = {});

/// Fits a linear model to D (mGal) by fit_robust().  The weights are in the order of the rows.
/// @param rows    (n), each with a reference.
/// @param origin  instant at which t = 0.
/// @param priors  priors on the slopes.
/// @return std::nullopt without rows, or as fit_robust().
/// @throws InputError  as model_columns().
[[nodiscard]] std::optional<RobustFit> fit_robust_model(const LinearModel& model,
                                                        const std::vector<reading::SurveyRow>& rows,
                                                        const TimeOrigin& origin,
                                                        const Priors& priors);

/// Returns the scores of the robust fit, under the name `robust`.  LOO and LOSO repeat the whole
/// fit without each row or station; they are absent if one of these fits is not determined.  There
/// is no AICc.  dof is n - p, priors not counted.
///
/// LOO and LOSO include the bad rows, which are predicted as well; they can be large although the
/// fit is good.  If the fit is not determined, only row_count and parameter_count are set.
/// Cost: n fits and one for each station.
/// @param model, rows, origin, priors  as fit_robust_model().
[[nodiscard]] Score score_robust_model(const LinearModel& model,
                                       const std::vector<reading::SurveyRow>& rows,
                                       const TimeOrigin& origin, const Priors& priors);

}  // namespace a351::corrector::model
