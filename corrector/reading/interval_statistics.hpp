#pragma once
/// @file
/// Statistics of an occupation within its interval.
///
/// The interval comes from choose_interval().  It is in indices of the decimated series, first and
/// last sample included.  All functions are pure, so several threads may call them at once.
///
///     const auto part = std::span(series.values()).subspan(first, last - first + 1);
///     const double level = signal::mean_of(part);
///     const std::optional<double> error = block_standard_error(part, samples_per_minute);

#include <cstddef>
#include <optional>
#include <span>

#include "protocol/core/time_series.hpp"
#include "protocol/core/units.hpp"

namespace a351::corrector::reading {

/// Returns the standard error of the mean of `values`, estimated from the means m_k of B blocks:
///
///     sqrt(sum of (m_k - mean of m)^2 / ((B - 1) B))
///
/// This includes noise that is correlated over less than a block.  An incomplete block at the end
/// is left out.  For white noise of deviation s the result is s / sqrt(n)
/// (tests/unit/reading/interval_statistics_test.cpp).
///
/// The result is 0 if all block means are equal.  It is known to about 1 / sqrt(2 (B - 1)) of
/// itself, if the block means are independent and Gaussian.  A trend within the interval enlarges
/// it, because the trend is scatter of the block means.
/// @param values      (n) samples, any unit, finite; not checked.  NaN or infinity within a
///                    complete block gives NaN; in the incomplete block it has no effect.
/// @param block_size  samples per block, longer than the correlation of the noise; 60 s for an
///                    occupation.
/// @return unit of the values; std::nullopt for fewer than two blocks, or block_size 0.
[[nodiscard]] std::optional<double> block_standard_error(std::span<const double> values,
                                                         std::size_t block_size);

/// Shape of the temperature over an interval.  A turn is a change of direction by at least 0.2 of
/// the range.
///
/// A temperature effect of a full wave averages out over the interval; that of a drift or of half a
/// wave does not.  With `monotone` or `half_wave` and a range above 0.05 degC the reading is
/// doubtful (methods.md, "Bad rows").  A constant temperature is `monotone`.
enum class TemperatureShape {
    monotone,   ///< The difference of last and first value is at least 0.8 of the range.
    half_wave,  ///< At most one turn.  Its effect on the mean does not average out.
    turning,    ///< More than one turn.
};

/// Statistics of the temperature within an interval, from at least two valid samples.  A
/// default-constructed summary is meaningless.
struct TemperatureSummary {
    DegC mean;                      ///< Arithmetic mean of the valid samples.
    double slope_degc_per_h = 0.0;  ///< Slope of the least-squares line, degC/h.
    DegC range;                     ///< Largest value minus smallest value.
    /// Shape of the means of one minute, or of the samples if there are fewer than three means.
    TemperatureShape shape = TemperatureShape::monotone;
};

/// Summarises the samples first..last, both included; missing ones (NaN) are left out.
///
/// The slope is that of a line through all valid samples at their own times; it is right across
/// gaps.  For the shape, valid samples are taken in a row, as if there were no gaps.  Infinite
/// samples are not checked for, and make the slope NaN.
///
/// Indices beyond the end of the series are left out; first > last gives std::nullopt.
/// @param temperature  at any rate, missing samples NaN.  At one sample per minute or less, the
///                     shape is that of the samples, and their noise can look like turns.
/// @return std::nullopt for fewer than two valid samples.
[[nodiscard]] std::optional<TemperatureSummary> summarise_temperature(
    const TimeSeries<DegC>& temperature, std::size_t first, std::size_t last);

/// Statistics of one axis.
/// Both are NaN if no sample could be used.
struct AxisSummary {
    StandardGravity mean;  ///< Mean of the raw samples that have a trend.
    MilliGal rms;          ///< Rms about the trend: vibration and sensor noise.
};

/// Summarises the samples of `raw` from trend sample `first` to trend sample `last`, both included.
///
/// The trend is interpolated linearly between its samples.  Samples that are missing or have no
/// trend (NaN) are left out; if none is left, both results are NaN.
///
/// The rms has the divisor n, and its own mean is not removed.  A tilt of the axis within the
/// interval is part of the trend and not of the rms.  Raw samples beyond the end of `raw` are left
/// out.
///
/// The time is proportional to (last - first) x ratio, with one vector of as many doubles.  With
/// first > last both results are NaN.
///
/// Precondition: the trend has the start of `raw` and 1 / ratio of its rate; last < trend.size().
/// @param raw    axis in g at the sensor's rate.
/// @param trend  decimated axis in g.
/// @param ratio  raw samples per trend sample, >= 1.
[[nodiscard]] AxisSummary summarise_axis(const TimeSeries<StandardGravity>& raw,
                                         const TimeSeries<StandardGravity>& trend,
                                         std::size_t ratio, std::size_t first, std::size_t last);

}  // namespace a351::corrector::reading
