#pragma once
/// @file
/// Lowering the rate of a series by a whole factor.  Choices: protocol/signal/decimation.md.

#include <cstddef>
#include <span>
#include <vector>

#include "protocol/core/time_series.hpp"

namespace a351::corrector {

/// A symmetric low-pass and the factor it was designed for; from design_decimation().
struct DecimationFilter {
    std::size_t factor = 1;
    std::vector<double> taps;  ///< Odd in number, symmetric, sum 1.

    [[nodiscard]] std::size_t half_width() const noexcept { return taps.size() / 2; }
};

/// Windowed-sinc low-pass of order N = 8 M + 2 with a Hamming window, cut off (-6 dB) at the new
/// Nyquist frequency:
///
///     h[n] = sinc((n - N/2) / M) / M (0.54 - 0.46 cos(2 pi n / N)),  n = 0 ... N,  then h / sum(h)
///
/// For M = 10: 83 taps, stop band from 0.07 of the input rate at -52.4 dB or below, white noise
/// variance times 0.091.
///
/// @param factor  M, 2 ... 1000.
/// @throws std::invalid_argument  another factor.
/// Source: A. V. Oppenheim and R. W. Schafer, Discrete-Time Signal Processing, 3rd ed., Pearson,
/// 2010, section 7.5 (window method).
[[nodiscard]] DecimationFilter design_decimation(int factor);

/// The least number of samples, none missing, of which `stages` in a row make a valid output.
/// A double, for it grows like M^stages; exact up to 2^53.
[[nodiscard]] double least_length(const DecimationFilter& filter, int stages);

/// Filters and keeps every M-th value, centred on its input, so that nothing is delayed:
///
///     y[k] = sum over m of h[m] x[M k + D - m],   D = (taps - 1) / 2,   k = 0 ... ceil(n / M) - 1
///
/// An output is valid when all its inputs exist and are finite, at most 1e307 in magnitude (the sum
/// of a pair must not overflow), and NaN otherwise.  Nothing is
/// padded and no gap is bridged: a missing input (NaN) costs the outputs that touch it, no others.
///
/// Accuracy: a constant returns unchanged to 1e-14 relative (decimation_test.cpp).
[[nodiscard]] std::vector<double> decimate(std::span<const double> input,
                                           const DecimationFilter& filter);

/// The same; output k has the time of input M k.
template <class Unit>
[[nodiscard]] TimeSeries<Unit> decimate(const TimeSeries<Unit>& input,
                                        const DecimationFilter& filter) {
    return {input.start(), Hertz(input.rate().value() / static_cast<double>(filter.factor)),
            decimate(std::span<const double>(input.values()), filter)};
}

/// decimate() `stages` times over: the rate falls by M^stages.
template <class Unit>
[[nodiscard]] TimeSeries<Unit> decimate(TimeSeries<Unit> series, const DecimationFilter& filter,
                                        int stages) {
    for (int stage = 0; stage < stages; ++stage) series = decimate(series, filter);
    return series;
}

}  // namespace a351::corrector
