#pragma once
/// @file
/// Statistics of an occupation within its interval.

#include <cstddef>
#include <optional>
#include <span>

#include "protocol/core/time_series.hpp"
#include "protocol/core/units.hpp"

namespace a351::corrector {

/// Returns the arithmetic mean of (n) values, any unit; NaN for an empty span or if a value is NaN.
/// Differences from the first value are summed, which keeps rounding small near 980 000 mGal.
[[nodiscard]] double mean(std::span<const double> values);

/// Returns the standard error of the mean of `values`, estimated from the means m_k of B blocks:
///
///     sqrt(sum of (m_k - mean of m)^2 / ((B - 1) B))
///
/// This includes noise that is correlated over less than a block.  An incomplete block at the end
/// is left out.  For white noise of deviation s the result is s / sqrt(n)
/// (tests/unit/reading/interval_statistics_test.cpp).
/// @param values      (n) samples, any unit, finite.
/// @param block_size  samples per block.
/// @return unit of the values; std::nullopt for fewer than two blocks, or block_size 0.
[[nodiscard]] std::optional<double> block_standard_error(std::span<const double> values,
                                                         std::size_t block_size);

/// Shape of the temperature over an interval.  A turn is a change of direction by at least 0.2 of
/// the range.
enum class TemperatureShape {
    monotone,   ///< The difference of last and first value is at least 0.8 of the range.
    half_wave,  ///< At most one turn.  Its effect on the mean does not average out.
    turning,    ///< More than one turn.
};

struct TemperatureSummary {
    DegC mean;
    double slope_degc_per_h = 0.0;  ///< Slope of the least-squares line, degC/h.
    DegC range;                     ///< Largest value minus smallest value.
    /// Shape of the means of one minute, or of the samples if there are fewer than three means.
    TemperatureShape shape = TemperatureShape::monotone;
};

/// Summarises the samples first..last, both included; missing ones (NaN) are left out.
/// @param temperature  at any rate, missing samples NaN.
/// @return std::nullopt for fewer than two valid samples.
[[nodiscard]] std::optional<TemperatureSummary> summarise_temperature(
    const TimeSeries<DegC>& temperature, std::size_t first, std::size_t last);

/// Statistics of one axis.
struct AxisSummary {
    StandardGravity mean;
    MilliGal rms;  ///< Rms about the trend: vibration and sensor noise.
};

/// Summarises the samples of `raw` from trend sample `first` to trend sample `last`, both included.
///
/// The trend is interpolated linearly between its samples.  Samples that are missing or have no
/// trend (NaN) are left out; if none is left, both results are NaN.
///
/// Precondition: the trend has the start of `raw` and 1 / ratio of its rate; last < trend.size().
/// @param raw    axis in g at the sensor's rate.
/// @param trend  decimated axis in g.
/// @param ratio  raw samples per trend sample, >= 1.
[[nodiscard]] AxisSummary summarise_axis(const TimeSeries<StandardGravity>& raw,
                                         const TimeSeries<StandardGravity>& trend,
                                         std::size_t ratio, std::size_t first, std::size_t last);

}  // namespace a351::corrector
