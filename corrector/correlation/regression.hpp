#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace a351::corrector {

/// A line y = slope x + intercept by least squares.
struct LineFit {
    double slope = 0.0;
    double slope_error = 0.0;  ///< Standard error, neighbours correlated.
    double intercept = 0.0;    ///< At x = 0.
    double mean_x = 0.0, mean_y = 0.0;
    double r2 = 0.0;
    std::size_t count = 0;
};

/// @param x, y         (n), n >= 3, finite.  A constant x has slope and R2 0.
/// @param correlated   samples over which residuals are correlated: the Bartlett window of the slope's
///                     standard error.
/// Source of the error: W. K. Newey and K. D. West, Econometrica 55, 703-708, 1987.
[[nodiscard]] LineFit fit_line(std::span<const double> x, std::span<const double> y,
                               std::size_t correlated = 0);

/// Without straight line.
[[nodiscard]] std::vector<double> without_line(std::span<const double> values);

[[nodiscard]] double mean_of(std::span<const double> values);
/// About the mean, divisor n.
[[nodiscard]] double variance_of(std::span<const double> values);

}  // namespace a351::corrector
