#pragma once
/// @file
/// Samples of the sensor's own clock -> values on whole multiples of a period of UTC.

#include <cstdint>
#include <vector>

#include "protocol/archive/archive_reader.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector {

/// Instant k / rate_hz after 1970, to the nanosecond before it.
[[nodiscard]] UtcTime grid_time(std::int64_t k, int rate_hz);

/// The first k whose grid_time() is not before `time`.
[[nodiscard]] std::int64_t first_on_grid(UtcTime time, int rate_hz);

/// Values without a gap; the first stands at grid_time(first).
struct GridRun {
    std::int64_t first = 0;
    std::vector<double> values;
};

/// Band-limited interpolation with a Kaiser-windowed sinc:
///
///     y(t) = sum over j of h(u(t) - j) x[j] / sum over j of h(u(t) - j)
///     h(d) = sinc(c d) I0(b sqrt(1 - (c d / Z)^2)) / I0(b),   |c d| <= Z = 32,   b = 10
///
/// u(t) is the sample that t falls on: linear between the starts of neighbouring records, on at the
/// same rate in the last one, by the header's rate where there is but one.  c = rate / rate of the samples, at most 1: a lower rate is
/// low-passed on the way.
class UtcGrid {
public:
    /// @param source_rate_hz  of the samples, as in the header.
    /// @throws std::invalid_argument  rate_hz < 1 or above the samples' (to 1 %).
    UtcGrid(double source_rate_hz, int rate_hz);

    /// Values from grid instants within [from, to).  Those whose samples do not all lie inside the
    /// segment are not made: 0.64 s at either end at 50 Hz from 50 Hz.
    ///
    /// Accuracy: a constant comes back to 1e-9 counts; sines up to 0.4 of the rate within 1e-5 of their
    /// amplitude, sampled 100 ppm off; what lies above 0.6 of the rate is down to 1e-4
    /// (utc_grid_test.cpp).  To this come the errors of the samples' times, as the archive has them.
    /// Source: A. V. Oppenheim and R. W. Schafer, Discrete-Time Signal Processing, 3rd ed., Pearson,
    /// 2010, sections 4.6 (resampling) and 7.5.3 (Kaiser window).
    [[nodiscard]] GridRun resample(const record::Segment& segment, UtcTime from, UtcTime to) const;

private:
    [[nodiscard]] double at(const std::vector<std::int32_t>& counts, double position) const;

    int rate_hz_;
    double half_width_;           ///< Of h, samples.
    std::vector<double> kernel_;  ///< h from 0 to half_width_, kSteps to a sample.
};

}  // namespace a351::corrector
