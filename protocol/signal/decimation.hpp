#pragma once
/// @file
/// Decimation: lowers the rate of a series by a whole factor.  Choices:
/// protocol/signal/decimation.md.
///
/// Use it for a series that is in memory.  For one that arrives in pieces use Decimator, which
/// gives the same bits.
///
///     const DecimationFilter filter = design_decimation(10);
///     const auto slow = decimate(series, filter, 2);  // 50 Hz -> 0.5 Hz
///
/// The transition band is wide: for M = 10 a signal at 0.05 to 0.06 of the input rate folds back,
/// attenuated by only 6 to 18 dB (decimation_test.cpp).

#include <cstddef>
#include <span>
#include <vector>

#include "protocol/core/time_series.hpp"

namespace a351::signal {

/// Symmetric low-pass and the decimation factor for which it was designed by design_decimation().
///
/// A default-constructed filter has no taps and must not be used.
struct DecimationFilter {
    std::size_t factor = 1;    ///< M: each M-th value is kept; 2 to 1000 from the design.
    std::vector<double> taps;  ///< h (N + 1): an odd number of taps, symmetric, sum 1.

    /// Returns D = N / 2, the number of taps on either side of the middle one: 4 M + 1.  An output
    /// needs D samples before and D samples after its own time.
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
/// The sum of the taps is 1, so a constant keeps its value.  Cost: O(M); deterministic.
///
/// @param factor  M, 2 to 1000.
/// @return the filter with 8 M + 3 taps, dimensionless.
/// @throws std::invalid_argument  the factor is outside this range.
/// Source: A. V. Oppenheim and R. W. Schafer, Discrete-Time Signal Processing, 3rd ed., Pearson,
/// 2010, section 7.5 (window method).
[[nodiscard]] DecimationFilter design_decimation(int factor);

/// Returns the least number of samples, none of them missing, that gives a valid output after
/// `stages` decimations in a row.  The result is a double because it grows like M^stages.
///
/// Use it to refuse a record that is too short before it is decimated.
///
/// Accuracy: exact up to 2^53; 952 for M = 10 and two stages (decimation_test.cpp).
/// @param stages  >= 0; not checked.  0 gives 1: one sample is an output of itself.
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
/// Cost: O(n), about 4 multiplications per input sample; allocates O(n / M).  Deterministic: every
/// variant of the inner loop gives the same bits (decimator_test.cpp).
///
/// Accuracy: a constant returns unchanged to 1e-14 relative, and a ramp is not delayed
/// (decimation_test.cpp).
///
/// @param input   x (n), any unit, magnitude at most 1e307, so that the sum of a pair does not
///                overflow; n = 0 gives no output.
/// @param filter  from design_decimation(); not checked.
/// @return y (ceil(n / M)), in the unit of the input.
[[nodiscard]] std::vector<double> decimate(std::span<const double> input,
                                           const DecimationFilter& filter);

/// Decimates a time series: output k has the time of input M k, and the rate falls by M.  The start
/// is unchanged.  Missing values and cost are those of decimate() above.
template <class Unit>
[[nodiscard]] TimeSeries<Unit> decimate(const TimeSeries<Unit>& input,
                                        const DecimationFilter& filter) {
    return {input.start(), Hertz(input.rate().value() / static_cast<double>(filter.factor)),
            decimate(std::span<const double>(input.values()), filter)};
}

/// Decimates a time series `stages` times: the rate falls by M^stages.  `stages` <= 0 returns the
/// series unchanged.
///
/// Twenty minutes at 50 Hz, decimated twice by 10, give 600 outputs.  Outputs 5 to 595 of them are
/// valid (decimation_test.cpp).  Precondition: `filter` is from design_decimation().
template <class Unit>
[[nodiscard]] TimeSeries<Unit> decimate(TimeSeries<Unit> series, const DecimationFilter& filter,
                                        int stages) {
    for (int stage = 0; stage < stages; ++stage) series = decimate(series, filter);
    return series;
}

}  // namespace a351::signal
