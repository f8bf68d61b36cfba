#pragma once
/// @file
/// Ordinary least squares with a constant, in centred form, and what is asked of a fit afterwards.

#include <Eigen/Core>
#include <optional>

namespace a351::corrector {

/// y = b0 + X b + noise, fitted on y - mean(y) and X - mean(X): full values near 980000 keep their
/// last digits.
struct LinearFit {
    Eigen::VectorXd coefficients;  ///< (p) constant first, then one per column of X.
    Eigen::MatrixXd cofactor;      ///< (p, p) covariance of the coefficients / s^2.
    Eigen::VectorXd residuals;     ///< (n) y - fit.
    Eigen::VectorXd leverages;     ///< (n) diagonal of the hat matrix; their sum is p.
    Eigen::VectorXd column_means;  ///< (p - 1)
    double mean = 0.0;             ///< Of y.
    double rss = 0.0;              ///< Sum of squared residuals.
    double prior_rss = 0.0;        ///< The same of the priors' rows.
    Eigen::Index prior_count = 0;
    double r_squared = 0.0;  ///< 1 - rss / sum (y - mean)^2; NaN for constant y.

    [[nodiscard]] Eigen::Index row_count() const { return residuals.size(); }
    [[nodiscard]] Eigen::Index parameter_count() const { return coefficients.size(); }
    /// Rows, those of the priors included, less coefficients.
    [[nodiscard]] Eigen::Index dof() const { return row_count() + prior_count - parameter_count(); }

    /// Value of the fit at x (p - 1).
    [[nodiscard]] double at(const Eigen::Ref<const Eigen::VectorXd>& x) const;

    /// 1/n + (x - mean)^T C (x - mean): for a row of the fit its leverage.
    [[nodiscard]] double leverage_at(const Eigen::Ref<const Eigen::VectorXd>& x) const;

    /// sqrt((rss + prior_rss) / dof); absent when dof = 0.
    [[nodiscard]] std::optional<double> residual_scale() const;
};

/// Known beforehand: each slope with a weight above 0 has one more row, weight (b - value) = 0.
struct SlopePriors {
    Eigen::VectorXd values;   ///< (p - 1), or empty: none.
    Eigen::VectorXd weights;  ///< (p - 1), std. deviation of a row / that of the prior.
};

/// @param columns  (n, p - 1), may have no column: then the mean of y is fitted.
/// @return std::nullopt when rows and priors are fewer than p, or leave a combination of the
///         columns and the constant open.
///
/// Source: N. R. Draper and H. Smith, Applied Regression Analysis, 3rd ed., Wiley 1998, ch. 5, 8.
[[nodiscard]] std::optional<LinearFit> fit_linear(const Eigen::Ref<const Eigen::MatrixXd>& columns,
                                                  const Eigen::Ref<const Eigen::VectorXd>& y,
                                                  const SlopePriors& priors = {});

}  // namespace a351::corrector
