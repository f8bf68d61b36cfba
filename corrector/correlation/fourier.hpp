#pragma once
/// @file
/// Fourier transforms of series of any length, padded with zeros to one that is fast.

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace a351::corrector {

using Spectrum = std::vector<std::complex<double>>;

/// The least number >= n without prime factors above 5.
[[nodiscard]] std::size_t fast_length(std::size_t n);

/// sum over i of x[i] exp(-2 pi i k i / length), k = 0 ... length / 2.
/// @param length  >= x.size()
[[nodiscard]] Spectrum half_spectrum(std::span<const double> x, std::size_t length);

/// The series as real part of one without negative frequencies; about its mean.  Wrong within about
/// a cycle of the ends.
[[nodiscard]] Spectrum analytic_signal(std::span<const double> x);

}  // namespace a351::corrector
