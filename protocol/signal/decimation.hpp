#pragma once
/// @file
/// Decimation: lowers the rate of a series by a whole factor.  Choices:
/// protocol/signal/decimation.md.

#include <cstddef>
#include <span>
#include <vector>

#include "protocol/core/time_series.hpp"

namespace a351::corrector {

/// Symmetric low-pass and the decimation factor for which it was designed by design_decimation().
struct DecimationFilter {
    std::size_t factor = 1;    ///< M: each M-th value is kept.
    std::vector<double> taps;  ///< h (N + 1): an odd number of taps, symmetric, sum 1.

    /// Returns D = N / 2, the number of taps on either side of the middle one.
    [[nodiscard]] std::size_t half_width() const noexcept { return taps.size() / 2; }
};

/// Returns a windowed-sinc low-pass of order N = 8 M + 2 with a Hamming window; its cut-off (-6 dB)
/// is the Nyquist frequency of the output:
///
///     h[n] = sinc((n - N/2) / M) / M (0.54 - 0.46 cos(2 pi n / N)),  n = 0 ... N,  then h / sum(h)
///
/// Accuracy: for M = 10 (83 taps) the gain is +0.03 dB at 0.01 of the input rate, -0.003 dB at
/// 0.03, -6.0 dB at 0.05, and below -52.4 dB from 0.07 on; the variance of white noise is
/// multiplied by 0.091 (decimation_test.cpp, "the filter of factor ten has the gains of its
/// design").
///
/// @param factor  M, 2 to 1000.
/// @throws std::invalid_argument  the factor is outside this range.
/// Source: A. V. Oppenheim and R. W. Schafer, Discrete-Time Signal Processing, 3rd ed., Pearson,
/// 2010, section 7.5 (window method).
[[nodiscard]] DecimationFilter design_decimation(int factor);

/// Returns the least number of samples, none of them missing, that gives a valid output after
/// `stages` decimations in a row.  The result is a double because it grows like M^stages.
///
/// Accuracy: exact up to 2^53; 952 for M = 10 and two stages (decimation_test.cpp).
/// @param stages  >= 0; not checked.
[[nodiscard]] double least_length(const DecimationFilter& filter, int stages);

/// Filters a series and keeps every M-th value.  The filter is centred on that value, so nothing is
/// delayed:
///
///     y[k] = sum over m of h[m] x[M k + D - m],   D = (taps - 1) / 2,   k = 0 ... ceil(n / M) - 1
///
/// Missing values: an output is NaN unless all its inputs exist and are finite.  Nothing is padded
/// and no gap is bridged: a NaN or infinite input makes those outputs NaN that use it, no others.
/// Each end loses ceil(D / M) outputs at most.
///
/// Accuracy: a constant returns unchanged to 1e-14 relative; a ramp and a tone keep their phase
/// (decimation_test.cpp).
///
/// @param input   x (n), any unit, magnitude at most 1e307, so that the sum of a pair does not
///                overflow; n = 0 gives no output.
/// @param filter  from design_decimation(); not checked.
/// @return y (ceil(n / M)), in the unit of the input.
[[nodiscard]] std::vector<double> decimate(std::span<const double> input,
                                           const DecimationFilter& filter);

/// Decimates a time series: output k has the time of input M k, and the rate falls by M.
template <class Unit>
[[nodiscard]] TimeSeries<Unit> decimate(const TimeSeries<Unit>& input,
                                        const DecimationFilter& filter) {
    return {input.start(), Hertz(input.rate().value() / static_cast<double>(filter.factor)),
            decimate(std::span<const double>(input.values()), filter)};
}

/// Decimates a time series `stages` times: the rate falls by M^stages.  `stages` <= 0 returns the
/// series unchanged.
template <class Unit>
[[nodiscard]] TimeSeries<Unit> decimate(TimeSeries<Unit> series, const DecimationFilter& filter,
                                        int stages) {
    for (int stage = 0; stage < stages; ++stage) series = decimate(series, filter);
    return series;
}

}  // namespace a351::corrector
