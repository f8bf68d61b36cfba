#pragma once
/// @file
/// Gain and phase of the acceleration against the temperature by period, in two independent ways.
///
/// H(period) = gain exp(i phase); phase > 0: the acceleration leads.  Limits are those of 95 %
/// confidence.  Methods: corrector/long_record/long_record.md, "Response by period".
///
/// A gain alone says nothing: noise has a gain too.  Use a point only if `refusal` is empty:
///
///     for (const ResponsePoint& point : response_by_spectrum(t, a, 20.0))
///         if (point.refusal.empty()) draw(point.period_s, point.gain, point.phase_deg);
///
/// Both ways use the same record, so their agreement does not make an error smaller.  All functions
/// are deterministic and may be called from several threads.
///
/// Accuracy of both ways (response_test.cpp): at least 85 % of the claimed points contain gain and
/// phase of the simulated plant within their limits.

#include <optional>
#include <span>
#include <vector>

#include "corrector/noise/limits.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::long_record {

using noise::Limits;

/// The response in one band, or of one mode.
///
/// If a point is refused, only its period, its limits and the rms of the temperature have a meaning.
/// `refusal` and `needed` are both empty or both not (response_test.cpp).
struct ResponsePoint {
    double period_s = 0.0;  ///< Period of the mean frequency of the temperature's power.
    /// Limits of the band; for a mode the octave about its period.
    double shortest_s = 0.0, longest_s = 0.0;
    Limits gain;       ///< mGal/degC; >= 0.
    Limits phase_deg;  ///< Positive: the acceleration leads; limits may be beyond +-180.
    /// Squared coherence, 0 to 1.  By modes: squared correlation of the mode and the acceleration.
    double coherence = 0.0;
    double temperature_rms_degc = 0.0;  ///< Rms of the temperature in the band or mode.
    text::Message refusal;              ///< Reason why no gain is claimed; empty if it is claimed.
    text::Message needed;               ///< Record that would show a gain; empty if it is claimed.
};

/// Shortest period of a response, s.  Reason: three filters attenuate shorter ones.
inline constexpr double kShortestResponse_s = 120.0;
/// 1 - confidence of the limits, dimensionless.  Reason: 95 % limits are usual.
inline constexpr double kSignificance = 0.05;

/// Options of response_by_spectrum().
struct ResponseOptions {
    double cycle_s = 900.0;  ///< Cycle of the oven; one half-octave band has it in its middle.
    bool is_joint = false;   ///< True: kSignificance is that of all bands together (Bonferroni).
    /// Noise of the thermometer as in ThermometerSpectrum; empty: it is measured.  A residual needs
    /// that of the record, because it contains the noise times the response.
    std::optional<double> noise_degc2{};
};

/// Computes the response by cross-spectra.
///
/// Both series without a straight line are multiplied by sine tapers over the whole segment;
/// spectra are averaged over the tapers and over half-octave bands.  3 to 15 tapers are used, as
/// many as resolve half the band.  H = S_aT / (S_TT - N), coherence = |S_aT|^2 / (S_TT S_aa).  The
/// limits are a circle about H:
///
///     |H - estimate|^2 <= (significance^(-1 / (nu - 1)) - 1) (1 - coherence)
///                         S_aa S_TT / (S_TT - N)^2
///
/// N is the thermometer's noise (ThermometerSpectrum), without which a gain would be too low.
/// nu is the number of resolutions that the temperature's power fills in the band, minus one, at
/// least 2: a spectral line counts as little more than the tapers.
///
/// A point is refused if one of these is true; limits are always finite (response_test.cpp):
///
/// - The record has fewer than 6 cycles.
/// - More than a fifth of the temperature's power is the thermometer's noise.
/// - The limits of the gain reach 0.
/// - A series is constant.
/// @param temperature_degc   (n) finite, n >= 3.
/// @param acceleration_mgal  (n) finite.
/// @param step_s             time between samples, s.
/// @param options            see ResponseOptions.
/// @return one point per band, the fastest first; refused ones too.  The middle of the first band
///         is above kShortestResponse_s.
/// Source: J. S. Bendat and A. G. Piersol, Random Data, 4th ed., Wiley 2010, section 9.2 (after N.
/// R. Goodman, 1957).  Tapers: K. S. Riedel and A. Sidorenko, IEEE Trans. Signal Process. 43,
/// 188-195, 1995.
[[nodiscard]] std::vector<ResponsePoint> response_by_spectrum(
    std::span<const double> temperature_degc, std::span<const double> acceleration_mgal,
    double step_s, const ResponseOptions& options = {});

/// Power spectrum of the temperature, and the noise of the thermometer.  White noise of variance v
/// has the expected power v at every frequency.
///
/// The noise is the power at periods from 70 to 110 s that the acceleration does not follow:
/// N = (S_TT - |S_aT|^2 / S_aa) n / (n - 1), with n frequencies.  So a true fluctuation of the
/// temperature, which the fast path shows, is not taken for noise (two_path_fit_test.cpp).
///
/// `noise` is 0 if no frequency is between 70 and 110 s, because the steps are too long or the
/// record is too short.
struct ThermometerSpectrum {
    std::vector<double> power;  ///< degC^2 at the frequencies k / (n step); seven sine tapers.
    double noise = 0.0;         ///< N, degC^2, of the first taper.
};
/// Returns the power spectrum of the temperature without a straight line.
/// @param temperature_degc   (n) finite, with n = fast_length(n).
/// @param acceleration_mgal  (n) finite.
/// @param step_s             time between samples, s.
[[nodiscard]] ThermometerSpectrum thermometer_spectrum(std::span<const double> temperature_degc,
                                                       std::span<const double> acceleration_mgal,
                                                       double step_s);

/// Computes the response by modes of the temperature.
///
/// Temperature and acceleration are projected on each mode: H = sum a z* / sum T z*, with the
/// analytic signals a, T and z of acceleration, temperature and mode.  The mode only selects; no
/// mode of the acceleration has to be matched with it.  Half a period at either end is left out.
///
/// The limits are the wider of two:
/// - a jackknife over 4 to 24 blocks of at least three cycles, which shows how the response varies
///   along the record;
/// - chance: the gains that appear if the rest a - H T is shifted around the record.
///
/// A point is refused with fewer than 13 cycles, if half or twice the gain is within the limits, or
/// if a series is constant.  Modes with a period below kShortestResponse_s are skipped.
/// @param modes              modes of the temperature (n each), fastest first; without the residue.
/// @param temperature_degc   (n) finite.
/// @param acceleration_mgal  (n) finite.
/// @param step_s             time between samples, s.
/// @return one point per mode that is not skipped, in the order of the modes; refused ones too.
[[nodiscard]] std::vector<ResponsePoint> response_by_modes(
    const std::vector<std::vector<double>>& modes, std::span<const double> temperature_degc,
    std::span<const double> acceleration_mgal, double step_s);

}  // namespace a351::corrector::long_record
