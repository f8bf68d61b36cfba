#pragma once
/// @file
/// Correlation of temperature with the acceleration some time later.

#include <optional>
#include <span>
#include <vector>

namespace a351::corrector {

/// Where the acceleration `delay_s` after the temperature (before it, if negative) correlates most.
struct CorrelationPeak {
    double delay_s = 0.0;  ///< Refined by a parabola through three lags.
    double value = 0.0;    ///< -1 to 1.
};

struct CrossCorrelation {
    std::vector<double> delays_s;
    std::vector<double> values;
    CorrelationPeak negative;  ///< The strongest of either sign within half a cycle of zero.
    CorrelationPeak positive;
};

/// Each overlap about its own means.
/// @param temperature, acceleration  (n), neither constant, n > 2 x half_cycle.
/// @param half_cycle  lags searched for peaks on either side, >= 2; lags up to twice that are given.
[[nodiscard]] CrossCorrelation correlate(std::span<const double> temperature,
                                         std::span<const double> acceleration, int half_cycle,
                                         double step_s);

}  // namespace a351::corrector
