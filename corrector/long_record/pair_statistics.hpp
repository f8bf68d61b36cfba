#pragma once
/// @file
/// What the publication tells of temperature and acceleration in the band of the oven's cycle.

#include <span>
#include <string>

#include "corrector/correlation/cross_correlation.hpp"
#include "corrector/correlation/regression.hpp"

namespace a351::corrector {

/// Of two series in a narrow band, or of two modes.
struct PairStatistics {
    double period_s = 0.0;                ///< Between rising zero crossings of the temperature.
    double temperature_swing_degc = 0.0;  ///< Peak to peak of a sine of that deviation ...
    double acceleration_swing_mgal = 0.0;
    LineFit moved;  ///< Acceleration, sign turned and `shift_s` earlier, over temperature.
    double shift_s = 0.0;
    CrossCorrelation correlation;
};

/// @param temperature_degc, acceleration_mgal  (n) about zero; n > 4 cycles.
/// @param cycle_s  of the oven, by which peaks are searched and errors are estimated.
/// @param shift_s  by which the acceleration is moved, as the publication does by 280 s.
[[nodiscard]] PairStatistics pair_statistics(std::span<const double> temperature_degc,
                                             std::span<const double> acceleration_mgal,
                                             double step_s, double cycle_s, double shift_s);

/// The phase of acceleration against temperature that both peaks say, degrees in (-180, 180].
[[nodiscard]] double phase_of_peaks_deg(const PairStatistics& pair);

/// Rate coefficient that the part in quadrature amounts to, mGal per degC/h.
[[nodiscard]] double rate_coefficient(const PairStatistics& pair);

/// What the two peaks mean, in sentences: what cannot come before its cause, and what both are at once.
[[nodiscard]] std::string causal_reading(const PairStatistics& pair);

}  // namespace a351::corrector
