#pragma once
/// @file
/// The publication's statistics of temperature and acceleration in the band of the oven's cycle.
///
///     const PairStatistics pair = pair_statistics(t, a, 20.0, 900.0, 280.0);
///     if (pair.period_s > 0.0) std::cout << causal_reading(pair) << '\n';
///
/// In a narrow band two peaks of the correlation describe one response.  A negative peak that is
/// late and a positive peak that is early are therefore no contradiction: phase_of_peaks_deg()
/// combines both.  The statistics mean nothing if the band shows no response; response.hpp tests
/// that.

#include <span>

#include "protocol/signal/regression.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::long_record {

/// Statistics of two series in a narrow band, or of two modes.  A swing is 2 sqrt(2) standard
/// deviations.
struct PairStatistics {
    /// Mean time between rising zero crossings of the temperature; 0 with fewer than two.
    double period_s = 0.0;
    /// Peak-to-peak value of a sine with the standard deviation of the temperature.
    double temperature_swing_degc = 0.0;
    double acceleration_swing_mgal = 0.0;  ///< Same for the acceleration.
    signal::LineFit
        moved;  ///< Acceleration, sign inverted and `shift_s` earlier, over temperature.
    double shift_s = 0.0;
    /// Delays of the acceleration after the temperature, up to an hour, as published, or a cycle.
    signal::CrossCorrelation correlation;
    double chance = 0.0;  ///< Size that a correlation exceeds by chance at 5 % of the delays.
};

/// Computes the statistics of a pair of series.
///
/// Peaks of the correlation are searched within half a cycle on either side of 0.  The standard
/// error of the slope is for residuals that are correlated over four cycles.  Cost: O(n cycle_s /
/// step_s), and an hour at least.
/// @param temperature_degc   (n) about zero; n > 4 cycles.  Finite and not constant.
/// @param acceleration_mgal  (n) about zero.  Finite and not constant.
/// @param step_s             time between samples, s.
/// @param cycle_s            cycle of the oven, s.
/// @param shift_s            time by which the acceleration is moved earlier, s, >= 0; the
///                           publication takes 280 s.  It is rounded to whole samples, and leaves
///                           three samples at least.
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

/// Returns the rate coefficient that explains the part in quadrature, mGal per degC/h; positive if
/// the acceleration grows while the temperature rises:
/// gain sin(phase) / (2 pi / P), where gain is |negative peak| times the ratio of the swings.
///
/// Accuracy: 9.9 +- 0.1 mGal per degC/h for a sine with a known response (indoor_record_test.cpp).
/// @param pair  with a period > 0.
[[nodiscard]] double rate_coefficient(const PairStatistics& pair);

/// Returns the meaning of the two peaks in sentences: delays, sizes, phase, and response to the
/// temperature or to its rate of change.
///
/// If both peaks are below 0.3 in size, the text says that the band shows no response.  If they
/// differ by more than a factor of 1.25, it says that the band is not narrow.  A phase within 45
/// degrees of +-90 is called a response to the rate of change.
/// @param pair  with a period > 0.
[[nodiscard]] text::Message causal_reading(const PairStatistics& pair);

}  // namespace a351::corrector::long_record
