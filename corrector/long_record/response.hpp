#pragma once
/// @file
/// Gain and phase of the acceleration against the temperature by period, in two independent ways.

#include <span>
#include <string>
#include <vector>

namespace a351::corrector {

/// With the limits of 95 % confidence.
struct Limits {
    double value = 0.0, low = 0.0, high = 0.0;
};

/// Of one band or mode.
struct ResponsePoint {
    double period_s = 0.0;  ///< Mean frequency of the temperature's power in it, as a period.
    double shortest_s = 0.0,
           longest_s = 0.0;  ///< Of the band; of a mode the octave about its period.
    Limits gain;             ///< mGal/degC
    Limits phase_deg;        ///< Positive: the acceleration leads; limits may pass +-180.
    double coherence = 0.0;  ///< Squared; by modes, of the mode and the whole acceleration.
    double temperature_rms_degc = 0.0;
    std::string refusal;  ///< Why no gain is claimed; else empty.
    std::string needed;   ///< What record would show one.
};

struct ResponseOptions {
    double cycle_s = 900.0;     ///< Bands are half octaves about this and its multiples.
    double shortest_s = 120.0;  ///< Three filters of the decimation leave less below.
    double cycles = 6.0;        ///< Of a period that the record must hold.
    double significance = 0.05;
};

/// By cross-spectra: sine tapers over the whole segment, averaged in half-octave bands, as many tapers
/// as resolve half the band.
///
/// The limits are the circle of J. S. Bendat and A. G. Piersol, Random Data, 4th ed., Wiley 2010,
/// section 9.2 (after N. R. Goodman, 1957) with the degrees of freedom that the temperature's power
/// really has in the band: a line counts as little more than the tapers.
/// Tapers: K. S. Riedel and A. Sidorenko, IEEE Trans. Signal Process. 43, 188-195, 1995.
/// @param temperature_degc, acceleration_mgal  (n)
[[nodiscard]] std::vector<ResponsePoint> response_by_spectrum(
    std::span<const double> temperature_degc, std::span<const double> acceleration_mgal,
    double step_s, const ResponseOptions& options = {});

/// Power of the temperature, and what of it is the thermometer's white noise.
struct ThermometerSpectrum {
    std::vector<double> power;  ///< At k / (n step), n of fast_length(); seven sine tapers.
    double noise = 0.0;         ///< Mean of the power between 70 and 110 s, which no oven moves.
};
/// @param temperature_degc  (n), n of fast_length().
[[nodiscard]] ThermometerSpectrum thermometer_spectrum(std::span<const double> temperature_degc,
                                                       double step_s);

/// By modes: each mode of the temperature as the instrument on which temperature and acceleration
/// are projected, H = sum a z* / sum T z* with their analytic signals, so that no mode of the
/// acceleration has to be matched.  The limits are the wider of two: blocks left out in turn
/// (jackknife), that is how much the response differs along the record; and the gains that appear when
/// what the response leaves is shifted along the record, that is chance.
/// @param modes  of the temperature, fastest first.
[[nodiscard]] std::vector<ResponsePoint> response_by_modes(
    const std::vector<std::vector<double>>& modes, std::span<const double> temperature_degc,
    std::span<const double> acceleration_mgal, double step_s, const ResponseOptions& options = {});

}  // namespace a351::corrector
