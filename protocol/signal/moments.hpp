#pragma once

#include <cmath>
#include <limits>
#include <span>

namespace a351::signal {

/// Returns the mean of (n) values; NaN for none, or if a value is NaN.
///
/// Differences from the first value are summed, which keeps the digits of values near 980 000 mGal.
/// The mean of equal values is exactly this value.
[[nodiscard]] inline double mean_of(std::span<const double> values) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    double sum = 0.0;
    for (const double value : values) sum += value - values.front();
    return values.front() + sum / static_cast<double>(values.size());
}

/// Returns the variance about the mean, divisor n; NaN for none.
[[nodiscard]] inline double variance_of(std::span<const double> values) {
    const double mean = mean_of(values);
    double squares = 0.0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    return squares / static_cast<double>(values.size());
}

/// Returns the standard deviation of a sample, divisor n - 1; NaN for less than two values.
[[nodiscard]] inline double sample_sd_of(std::span<const double> values) {
    const auto n = static_cast<double>(values.size());
    return n < 2.0 ? std::numeric_limits<double>::quiet_NaN()
                   : std::sqrt(variance_of(values) * n / (n - 1.0));
}

}  // namespace a351::signal
