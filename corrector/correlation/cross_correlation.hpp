#pragma once
/// @file
/// Cross-correlation of temperature and acceleration.
///
/// Sign of a delay: positive if the acceleration follows the temperature.

#include <optional>
#include <span>
#include <vector>

namespace a351::corrector {

/// The strongest correlation of one sign.
struct CorrelationPeak {
    double delay_s = 0.0;  ///< Delay of the acceleration, refined by a parabola through three lags.
    double value = 0.0;    ///< Correlation at the top of the parabola, about -1 to 1.
};

/// Correlations by delay.
struct CrossCorrelation {
    std::vector<double> delays_s;  ///< (4 half_cycle + 1) Delays, ascending about 0.
    std::vector<double> values;    ///< (4 half_cycle + 1) Correlations, -1 to 1.
    CorrelationPeak negative;      ///< Least correlation within half_cycle lags of 0.
    CorrelationPeak positive;      ///< Greatest correlation within half_cycle lags of 0.
};

/// Correlates the temperature with the acceleration `lag` steps later, for lags of -2 half_cycle to
/// 2 half_cycle:
///
///     r(lag) = sum dT_i da_(i+lag) / sqrt(sum dT_i^2 sum da_(i+lag)^2)
///
/// dT and da are about their means.  Sums and means are over the samples that overlap.  The
/// parabola moves a peak by at most one step.
/// Accuracy: for sines of 900 s at steps of 20 s both peaks are within 1 s
/// (indoor_record_test.cpp).
/// @param temperature   (n) finite, not constant in any overlap; n > 2 half_cycle.
/// @param acceleration  (n) likewise, any unit.
/// @param half_cycle    number of lags searched for peaks on either side of 0, >= 2.
/// @param step_s        time between samples, s, > 0.
[[nodiscard]] CrossCorrelation correlate(std::span<const double> temperature,
                                         std::span<const double> acceleration, int half_cycle,
                                         double step_s);

}  // namespace a351::corrector
