#pragma once
/// @file
/// Straight line through a series with correlated residuals, mean and variance.

#include <cstddef>
#include <span>
#include <vector>

namespace a351::corrector {

/// A line y = slope x + intercept.
struct LineFit {
    double slope = 0.0;                 ///< Unit of y per unit of x.
    double slope_error = 0.0;           ///< Standard error of the slope with correlated residuals.
    double intercept = 0.0;             ///< Value at x = 0.
    double mean_x = 0.0, mean_y = 0.0;  ///< Means of x and y.
    double r2 = 0.0;                    ///< Squared correlation of x and y, 0 to 1.
    std::size_t count = 0;              ///< n
};

/// Fits a line by least squares: slope = sum dx dy / sum dx^2, with dx and dy about their means.
///
/// The standard error allows for correlated residuals.  With m_i = dx_i x residual_i and the
/// Bartlett weights w_l = 1 - l / (correlated + 1):
///
///     slope_error^2 = (sum m_i^2 + 2 sum_l w_l sum m_i m_(i-l)) / (sum dx^2)^2,  l = 1 ...
///     correlated
///
/// A constant x has slope, slope_error and R2 0; a constant y has R2 0.
/// @param x, y        (n) finite, n >= 3.
/// @param correlated  number of samples over which residuals are correlated; 0: independent.  Lags
///                    above n - 1 do not exist and are left out.
/// Source of the error: W. K. Newey and K. D. West, Econometrica 55, 703-708, 1987.
[[nodiscard]] LineFit fit_line(std::span<const double> x, std::span<const double> y,
                               std::size_t correlated = 0);

/// Returns the series (n) minus its least-squares line over the sample number; its mean is 0.
/// @param values  (n) finite, n >= 3.
[[nodiscard]] std::vector<double> without_line(std::span<const double> values);

/// Returns the mean; NaN for an empty series.
[[nodiscard]] double mean_of(std::span<const double> values);
/// Returns the variance about the mean, divisor n; NaN for an empty series.
[[nodiscard]] double variance_of(std::span<const double> values);

}  // namespace a351::corrector
