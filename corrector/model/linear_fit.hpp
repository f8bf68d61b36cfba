#pragma once
/// @file
/// Ordinary least squares with a constant, in centred form, and the quantities derived from a fit.
///
/// Use it for few columns and rows of equal weight.  For rows of different weight divide them by
/// their standard deviation and use PivotedQr.
///
///     const auto fit = fit_linear(columns, y);
///     if (!fit) return;                                // the rows do not determine the slopes
///     const double predicted = fit->at(x);             // also for x outside the rows
///     if (const auto s = fit->residual_scale())        // absent if nothing is left to estimate it
///         std::sqrt(fit->covariance(*s)(1, 1));        // standard error of the first slope
///
/// All functions are pure, so several threads may call them.

#include <Eigen/Core>
#include <optional>

namespace a351::corrector::model {

/// Result of a fit of y = b0 + X b + noise, with n rows and p coefficients.
///
/// The fit is made on y - mean(y) and X - mean(X), so that full values near 980000 mGal keep their
/// last digits.
///
/// The standard error of coefficient k is sqrt(covariance(s)(k, k)).  A default-constructed fit is
/// empty and has no meaning.
struct LinearFit {
    Eigen::VectorXd coefficients;  ///< (p) Constant first, then one per column of X.
    /// (p, p) C, and the constant; without priors it is the covariance of the coefficients / s^2.
    Eigen::MatrixXd cofactor;
    /// (p, p) C W^2 C, and the constant: the covariance from errors of the priors / row_sd^2.
    Eigen::MatrixXd prior_cofactor;
    double row_sd = 0.0;           ///< SlopePriors::row_sd.
    Eigen::VectorXd residuals;     ///< (n) y - fit, unit of y.
    Eigen::VectorXd leverages;     ///< (n) Diagonal of the hat matrix; sum p without priors.
    Eigen::VectorXd column_means;  ///< (p - 1) Means of the columns of X.
    double mean = 0.0;             ///< Mean of y.
    double rss = 0.0;              ///< Sum of squared residuals of the n rows.
    double prior_rss = 0.0;        ///< Sum of squared residuals of the priors' rows.
    Eigen::Index prior_count = 0;  ///< Number of the priors' rows.
    double r_squared = 0.0;        ///< 1 - rss / sum (y - mean)^2; NaN for constant y.

    /// Returns n, without the priors' rows.
    [[nodiscard]] Eigen::Index row_count() const { return residuals.size(); }
    /// Returns p, the constant included.
    [[nodiscard]] Eigen::Index parameter_count() const { return coefficients.size(); }
    /// Returns the degrees of freedom: n + number of priors - p.  It is never negative.
    [[nodiscard]] Eigen::Index dof() const { return row_count() + prior_count - parameter_count(); }

    /// Returns the value of the fit, mean + (x - column_means) . b, in the unit of y.
    /// @param x  (p - 1) values of the columns, also outside the rows of the fit.
    [[nodiscard]] double at(const Eigen::Ref<const Eigen::VectorXd>& x) const;

    /// Returns 1/n + (x - column_means)^T C (x - column_means), where C is the cofactor without the
    /// constant.  For a row of the fit this is its leverage.
    ///
    /// It is at least 1/n.  Far from the rows it increases with the square of the distance, without
    /// a limit.
    /// @param x  (p - 1) values of the columns, also outside the rows of the fit.
    [[nodiscard]] double leverage_at(const Eigen::Ref<const Eigen::VectorXd>& x) const;

    /// Returns the covariance (p, p) of the coefficients, if a row has the standard deviation s and
    /// the priors have theirs:
    ///
    ///     s^2 C + (row_sd^2 - s^2) C W^2 C
    ///
    /// A slope that only its prior determines has the prior's standard deviation, whatever s is.
    /// @param s  standard deviation of a row, as residual_scale() returns it; unit of y.
    [[nodiscard]] Eigen::MatrixXd covariance(double s) const;

    /// Returns the variance of at(x): s^2 leverage_at(x) without priors.  The error of a new row y
    /// at x is sqrt(s^2 + variance_at(x, s)).
    /// @param x  (p - 1) values of the columns, also outside the rows of the fit.
    /// @param s  see covariance().
    [[nodiscard]] double variance_at(const Eigen::Ref<const Eigen::VectorXd>& x, double s) const;

    /// Returns s = sqrt((rss + prior_rss) / dof), in the unit of y; absent if dof = 0.
    [[nodiscard]] std::optional<double> residual_scale() const;
};

/// Prior knowledge of slopes.  Each slope with a weight above 0 adds one row to the least-squares
/// system: weight (b - value) = 0.
///
/// Both vectors are empty, or both have p - 1 elements; this is not checked.  A value without a
/// weight has no effect.
struct SlopePriors {
    Eigen::VectorXd values;  ///< (p - 1) Means, in the unit of the slopes; empty: no priors.
    /// (p - 1) Standard deviation of a row of y, divided by that of the prior; 0: no prior.
    Eigen::VectorXd weights;
    double row_sd = 0.0;  ///< This standard deviation of a row, unit of y.
};

/// Fits y = b0 + X b by least squares: minimises sum (y - b0 - X b)^2 + sum weight^2 (b - value)^2.
///
/// The coefficients are b = (Xc^T Xc + W^2)^-1 (Xc^T yc + W^2 value), with Xc and yc centred and W
/// the diagonal matrix of the weights; they are solved by QR decomposition with column pivoting.
/// The constant has no prior.
///
/// A column counts as determined if its pivot is above 1e-12 (1 + largest |X|) sqrt(n).  This |X|
/// is the largest of all columns, so choose units in which the columns are of similar size.
///
/// Cost: O((n + p) p^2), with some allocations.  The same input gives the same bits.
///
/// Accuracy (linear_fit_test.cpp): exact data leave residuals below 1e-12.  Adding 980000 to y
/// changes slopes by less than 1e-9 of their value.  A residual divided by 1 - leverage is the
/// error of predicting the row without it, also with priors.
/// @param columns  X (n, p - 1), finite; without columns the mean of y is fitted.
/// @param y        (n) finite.
/// @param priors   see SlopePriors.
/// @return std::nullopt if there are no rows, if rows and priors together are fewer than p, or if
///         they do not determine a combination of the columns (collinear or constant columns).
/// Source: N. R. Draper and H. Smith, Applied Regression Analysis, 3rd ed., Wiley 1998, ch. 5, 8.
[[nodiscard]] std::optional<LinearFit> fit_linear(const Eigen::Ref<const Eigen::MatrixXd>& columns,
                                                  const Eigen::Ref<const Eigen::VectorXd>& y,
                                                  const SlopePriors& priors = {});

}  // namespace a351::corrector::model
