#pragma once
/// @file
/// The publication's statistics of temperature and acceleration in the band of the oven's cycle.

#include <span>
#include <string>

#include "corrector/correlation/regression.hpp"

namespace a351::corrector {

/// Statistics of two series in a narrow band, or of two modes.
struct PairStatistics {
    /// Mean time between rising zero crossings of the temperature; 0 with fewer than two.
    double period_s = 0.0;
    /// Peak-to-peak value of a sine with the standard deviation of the temperature.
    double temperature_swing_degc = 0.0;
    double acceleration_swing_mgal = 0.0;  ///< Same for the acceleration.
    LineFit moved;  ///< Acceleration, sign inverted and `shift_s` earlier, over temperature.
    double shift_s = 0.0;
    CrossCorrelation correlation;  ///< Delays of the acceleration after the temperature.
};

/// Computes the statistics of a pair of series.
///
/// Peaks of the correlation are searched within half a cycle on either side of 0.  The standard
/// error of the slope is for residuals that are correlated over four cycles.
/// @param temperature_degc   (n) about zero; n > 4 cycles.
/// @param acceleration_mgal  (n) about zero.
/// @param step_s             time between samples, s.
/// @param cycle_s            cycle of the oven, s.
/// @param shift_s            time by which the acceleration is moved earlier, s, >= 0; the
///                           publication takes 280 s.
[[nodiscard]] PairStatistics pair_statistics(std::span<const double> temperature_degc,
                                             std::span<const double> acceleration_mgal,
                                             double step_s, double cycle_s, double shift_s);

/// Returns the phase of the acceleration relative to the temperature, degrees in (-180, 180];
/// positive: the acceleration leads.  It is the circular mean of the angles of both peaks, with the
/// period P:
///
///     180 - 360 (delay of the negative peak) / P   and   -360 (delay of the positive peak) / P
///
/// Accuracy: 76 +- 0.5 degrees for a sine with a known delay (indoor_record_test.cpp).
/// @param pair  with a period > 0.
[[nodiscard]] double phase_of_peaks_deg(const PairStatistics& pair);

/// Returns the rate coefficient that explains the part in quadrature, mGal per degC/h:
/// gain sin(phase) / (2 pi / P), where gain is |negative peak| times the ratio of the swings.
///
/// Accuracy: 9.9 +- 0.1 mGal per degC/h for a sine with a known response (indoor_record_test.cpp).
/// @param pair  with a period > 0.
[[nodiscard]] double rate_coefficient(const PairStatistics& pair);

/// Returns the meaning of the two peaks in sentences: delays, sizes, phase, and response to the
/// temperature or to its rate of change.
/// @param pair  with a period > 0.
[[nodiscard]] std::string causal_reading(const PairStatistics& pair);

}  // namespace a351::corrector
