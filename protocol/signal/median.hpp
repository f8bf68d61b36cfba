#pragma once
/// @file
/// Median, and the factor from a median absolute deviation to a standard deviation.
///
/// A robust scale of residuals r is kGaussianPerMad * median(|r|): outliers hardly change it.
///
///     for (double& r : residuals) r = std::abs(r);
///     const double sigma = kGaussianPerMad * median(residuals);

#include <algorithm>
#include <cstddef>
#include <vector>

namespace a351::signal {

/// Standard deviation of Gaussian noise divided by its median absolute deviation, dimensionless:
/// 1 / Phi^-1(3/4), rounded to four decimals.
inline constexpr double kGaussianPerMad = 1.4826;

/// Returns the middle value, in the unit of the input; for an even number of values, the upper of
/// the two middle ones, not their mean.  The result is always one of the values.
///
/// Exact: no arithmetic is done.  Cost: O(n) on average.  The vector is taken by value: a caller that needs it no more moves it.
/// @param values  (n), n >= 1, without NaN; not checked.  The order does not matter.  Infinite
///                values are allowed.
[[nodiscard]] inline double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace a351::signal
