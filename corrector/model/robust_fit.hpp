#pragma once
/// @file
/// MM estimation of a linear model: bounded influence of bad rows, whatever their residual.
/// P. J. Rousseeuw and A. M. Leroy, Robust regression and outlier detection, Wiley 1987 (start and
/// scale); V. J. Yohai, Ann. Statist. 15, 642-656, 1987 (MM); P. J. Huber, Robust statistics,
/// Wiley 1981, 7.6 (covariance).

#include <optional>
#include <string>

#include "corrector/model/model_fit.hpp"

namespace a351::corrector {

/// Of the bisquare: 95 % efficient for normal errors.
inline constexpr double kBisquareTuning = 4.685;

struct RobustFit {
    LinearFit fit;            ///< Coefficients and residuals are robust; cofactor of all rows.
    Eigen::VectorXd weights;  ///< (n) 1: fully counted, 0: not at all.
    double start_scale = 0.0;
    double s = 0.0;  ///< Of a row, so that s^2 times the cofactor is the covariance.
};

/// Start: least trimmed squares over all subsets of p rows for n <= 25, else over 3000 drawn by a
/// fixed seed; the ten best are concentrated.  Its scale is kept while bisquare weights settle.
/// Deterministic.
/// @return std::nullopt for n <= p, or when rows and priors do not determine the coefficients.
[[nodiscard]] std::optional<RobustFit> fit_robust(const Eigen::Ref<const Eigen::MatrixXd>& columns,
                                                  const Eigen::Ref<const Eigen::VectorXd>& y,
                                                  const SlopePriors& priors = {});

/// The same of a model's rows, each with a reference.
[[nodiscard]] std::optional<RobustFit> fit_robust_model(const LinearModel& model,
                                                        const std::vector<SurveyRow>& rows,
                                                        UtcTime origin, const ModelPriors& priors);

/// LOO and LOSO repeat the whole fit.  Without AICc.
[[nodiscard]] ModelScore score_robust_model(const LinearModel& model,
                                            const std::vector<SurveyRow>& rows, UtcTime origin,
                                            const ModelPriors& priors);

}  // namespace a351::corrector
