#pragma once
/// @file
/// Resampling: input on the sensor's clock, output at the UTC times k / rate_hz since 1970.

#include <cstdint>
#include <vector>

#include "protocol/archive/archive_reader.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector {

/// Returns the instant k / rate_hz seconds after 1970, rounded down to a nanosecond; k may be
/// negative.
[[nodiscard]] UtcTime grid_time(std::int64_t k, int rate_hz);

/// Returns the first k whose grid_time() is not before `time`.
[[nodiscard]] std::int64_t first_on_grid(UtcTime time, int rate_hz);

/// Values without a gap; the first is at grid_time(first).
struct GridRun {
    std::int64_t first = 0;
    std::vector<double> values;
};

/// Interpolates band-limited samples with a Kaiser-windowed sinc:
///
///     y(t) = sum over j of h(u(t) - j) x[j] / sum over j of h(u(t) - j)
///     h(d) = sinc(c d) I0(b sqrt(1 - (c d / Z)^2)) / I0(b),   |c d| <= Z = 32,   b = 10
///
/// u(t) is the sample position at time t.  It is linear between the starts of neighbouring records
/// and continues at the same rate in the last record.  In a segment of one record it has the
/// header's rate.  c = rate of the grid / rate of the samples, at most 1; a lower rate includes a
/// low-pass filter.
class UtcGrid {
public:
    /// @param source_rate_hz  rate of the samples in the header, Hz.
    /// @param rate_hz         rate of the grid, Hz.
    /// @throws std::invalid_argument  rate_hz is below 1, or more than 1 % above source_rate_hz.
    UtcGrid(double source_rate_hz, int rate_hz);

    /// Returns the values at grid instants within [from, to), in counts.  A value is left out if
    /// its filter reaches outside the segment: 0.64 s at either end for 50 Hz from 50 Hz.
    ///
    /// Accuracy (tests/unit/export/utc_grid_test.cpp): a constant returns within 1e-9 counts.
    /// Sines up to 0.4 of the rate are within 1e-5 of their amplitude, from a clock 100 ppm off.
    /// Frequencies above 0.6 of the rate are reduced to 1e-4.  The errors of the times in the
    /// archive are added to this.
    /// Source: A. V. Oppenheim and R. W. Schafer, Discrete-Time Signal Processing, 3rd ed.,
    /// Pearson, 2010, sections 4.6 (resampling) and 7.5.3 (Kaiser window).
    [[nodiscard]] GridRun resample(const record::Segment& segment, UtcTime from, UtcTime to) const;

private:
    [[nodiscard]] double at(const std::vector<std::int32_t>& counts, double position) const;

    int rate_hz_;
    double half_width_;           ///< Half-width of h, samples.
    std::vector<double> kernel_;  ///< h from 0 to half_width_, kSteps per sample.
};

}  // namespace a351::corrector
