#pragma once
/// @file
/// Power spectral density of a series with its limits.

#include <cstddef>
#include <vector>

#include "corrector/noise/limits.hpp"

namespace a351::corrector::noise {

/// One-sided power spectral density at one frequency, with 95 % limits.
struct Density {
    double frequency_hz = 0.0;
    Limits mgal2_per_hz;
};

/// Returns the Hann window of period n, whose transform is exact at the frequencies of the segment.  Its
/// mean square is 3/8.
[[nodiscard]] std::vector<double> hann(std::size_t n);

/// Returns the mean of the periodograms of segments that overlap by half, each without its straight
/// line and under a Hann window w (Welch 1967):
///
///     S(k / (L dt)) = 2 dt / sum of w^2  mean over segments of |sum over m of w_m x_m e^(-2 pi i k m / L)|^2
///
/// The limits are those of chi-square with 2 K / (1 + 2 (1 - 1 / K) rho) degrees of freedom for K
/// segments; rho = (sum of w_m w_(m + L / 2) / sum of w^2)^2 is the correlation of neighbours.  Values
/// below k = 3 are left out, because the line takes a part of them, and so is the highest one.
///
/// Accuracy: equal to the dense formula within 1e-9; 94 to 96 % of the limits contain the density of
/// white noise, at each frequency 91 to 98 % (spectral_density_test.cpp).
/// @param values   (n) mGal, finite, n >= 64.
/// @param step_s   time between samples.
/// @return lowest frequency first; L is the largest even number <= n / 8 with a fast transform, and
///         at least 32.
/// Source: P. D. Welch, IEEE Trans. Audio Electroacoustics 15, 70-73, 1967.
[[nodiscard]] std::vector<Density> spectral_density(const std::vector<double>& values,
                                                    double step_s);

/// Returns that of one segment length, as above.
/// @param length  even, 8 <= length <= n.
[[nodiscard]] std::vector<Density> spectral_density(const std::vector<double>& values,
                                                    double step_s, std::size_t length);

/// Returns that of several series: every segment lies within one of them, and only segments of one
/// series are correlated.
/// @param parts  finite, of any lengths; shorter ones than `length` have no segment.
/// @return empty without a segment.
[[nodiscard]] std::vector<Density> pooled_density(const std::vector<std::vector<double>>& parts,
                                                  double step_s, std::size_t length);

/// A part of a spectrogram: mean density in a band during an interval, counted from the first sample.
struct Tile {
    double start_s = 0.0, end_s = 0.0, low_hz = 0.0, high_hz = 0.0, mgal2_per_hz = 0.0;
};

/// Returns the spectrogram: spectral_density() of parts of two hours, each in segments of one hour.
///
/// A part begins every hour, and is shown for the hour in its middle.  The bands are a quarter
/// octave wide, or one frequency where this is wider.  A record of more than kMostColumns hours has
/// longer parts.
/// @param values  (n) mGal, finite.
/// @param step_s  time between samples, at most 200.
/// @return by time, then by frequency; empty for less than two hours.
[[nodiscard]] std::vector<Tile> spectrogram(const std::vector<double>& values, double step_s);
inline constexpr std::size_t kMostColumns = 168;  ///< Hours of a week.

}  // namespace a351::corrector::noise
