#pragma once
/// @file
/// Resampling: input on the sensor's clock, output at the UTC times k / rate_hz since 1970.
///
///     const UtcGrid grid(segment.rate_hz, 50);
///     const GridRun run = grid.resample(segment, from, to);
///     for (std::size_t i = 0; i < run.values.size(); ++i)
///         use(grid_time(run.first + static_cast<std::int64_t>(i), 50), run.values[i]);
///
/// All instants are on one grid, whatever the segment.  Runs of several segments and channels can
/// therefore be compared value by value.

#include <cstdint>
#include <vector>

#include "protocol/archive/archive_reader.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector::archive_series {

/// Returns the instant k / rate_hz seconds after 1970, rounded down to a nanosecond; k may be
/// negative.
///
/// Whole seconds are exact.  grid_time(k + rate_hz) is one second after grid_time(k).
/// @param rate_hz  1 or more, not checked; the result must be within 1678 to 2262.
[[nodiscard]] UtcTime grid_time(std::int64_t k, int rate_hz);

/// Returns the first k whose grid_time() is not before `time`.  For an instant of the grid it is
/// the number of this instant (utc_grid_test.cpp).
/// @param rate_hz  1 or more, not checked.
[[nodiscard]] std::int64_t first_on_grid(UtcTime time, int rate_hz);

/// Values without a gap, in counts; the first is at grid_time(first).  Without values `first` has
/// no meaning.
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
///
/// The kernel is tabulated in the constructor, 2048 values per sample.  Its linear interpolation is
/// part of the stated accuracy.  resample() may be called from several threads, and for any number
/// of segments of this rate.
class UtcGrid {
public:
    /// Prepares the filter for a pair of rates.
    /// @param source_rate_hz  rate of the samples in the header, Hz.
    /// @param rate_hz         rate of the grid, Hz.
    /// @throws std::invalid_argument  rate_hz is below 1, or more than 1 % above source_rate_hz.
    UtcGrid(double source_rate_hz, int rate_hz);

    /// Returns the values at grid instants within [from, to), in counts.  A value is left out if
    /// its filter reaches outside the segment: 0.64 s at either end for 50 Hz from 50 Hz.
    ///
    /// A segment that is too short, or outside [from, to), gives no values.  A value costs about 64
    /// products; for a lower rate more, in proportion to 1 / c.
    ///
    /// Accuracy (tests/unit/resampling/utc_grid_test.cpp): a constant returns within 1e-9 counts.
    /// Sines up to 0.4 of the rate are within 1e-5 of their amplitude, from a clock 100 ppm off.
    /// Frequencies above 0.6 of the rate are reduced to 1e-4.  The errors of the times in the
    /// archive are added to this.
    /// Source: A. V. Oppenheim and R. W. Schafer, Discrete-Time Signal Processing, 3rd ed.,
    /// Pearson, 2010, sections 4.6 (resampling) and 7.5.3 (Kaiser window).
    /// @param segment  as read_channel() gives it: at least one sample and one anchor.  It may have
    ///                 samples outside [from, to), which the filter needs.
    [[nodiscard]] GridRun resample(const archive::Segment& segment, UtcTime from, UtcTime to) const;

private:
    [[nodiscard]] double at(const std::vector<std::int32_t>& counts, double position) const;

    int rate_hz_;
    double half_width_;           ///< Half-width of h, samples.
    std::vector<double> kernel_;  ///< h from 0 to half_width_, kSteps per sample.
};

}  // namespace a351::corrector::archive_series
