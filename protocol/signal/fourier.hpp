#pragma once
/// @file
/// Fourier transforms of series of any length, padded with zeros to a length with a fast transform.

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace a351::signal {

/// Complex values by frequency or by sample.
using Spectrum = std::vector<std::complex<double>>;

/// Returns the least number >= n without prime factors above 5.
/// @param n  >= 1.
[[nodiscard]] std::size_t fast_length(std::size_t n);

/// Returns the spectrum X_k = sum over m of x_m exp(-2 pi i k m / length), k = 0 ... length / 2.
/// There is no factor 1 / length.
/// @param x       (n), finite, any unit; padded with zeros to `length`.
/// @param length  >= n, >= 1; fast_length(n) is fast.
/// @return (length / 2 + 1), in the unit of x.
[[nodiscard]] Spectrum half_spectrum(std::span<const double> x, std::size_t length);

/// Returns the analytic signal of x - mean(x): a complex series without negative frequencies, whose
/// real part is x - mean(x).  Within about a cycle of the ends it is wrong.
/// @param x  (n) finite, n >= 1.
/// @return (n), in the unit of x.
[[nodiscard]] Spectrum analytic_signal(std::span<const double> x);

}  // namespace a351::signal
