#pragma once
/// @file
/// Noise of the ground at the quietest and the noisiest seismic stations.

namespace a351::corrector::noise {

enum class GroundNoise { low, high };

/// Returns the amplitude spectral density of vertical acceleration of Peterson's new low or high
/// noise model, 10^((A + B lg T) / 20) with the constants of the part that T is in.
/// @param period_s  0.1 to 100 000; NaN outside.
/// @return mGal / sqrt(Hz)
/// Accuracy: the published levels at the corners within 0.1 dB (earth_noise_test.cpp).
/// Source: J. Peterson, Observations and modeling of seismic background noise, U.S. Geological Survey
/// Open-File Report 93-322, 1993, tables 3 and 4.
[[nodiscard]] double ground_noise_mgal_per_sqrt_hz(GroundNoise model, double period_s);

}  // namespace a351::corrector::noise
